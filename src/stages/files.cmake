# Explicit names, no glob: what is not listed is not built.
duoptic_stage(gray)
duoptic_stage(median)
duoptic_stage(gaussian)
duoptic_stage(halve)
duoptic_stage(match_around)
duoptic_stage(fill)
duoptic_stage(depth)
duoptic_stage(speckle)
