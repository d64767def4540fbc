# Explicit names, no glob: what is not listed is not built.
