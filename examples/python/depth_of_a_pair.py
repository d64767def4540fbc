"""How far is what the camera looks at? Two pictures and their rig in, metres out:
    depth_of_a_pair.py left.png right.png rig.json
"""
import sys

import duoptic

frame = duoptic.depth(sys.argv[1], sys.argv[2], rig=sys.argv[3])
height, width = frame.depth_m.shape
print(f"{frame.depth_m[height // 2, width // 2]:.2f} m in the middle; {(frame.depth_mm > 0).mean():.0%} of the picture is known")
