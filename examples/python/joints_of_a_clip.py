"""Where are people's hands, and what is the depth there? Two videos or cameras with their rig, or a recording, which has its own:
    joints_of_a_clip.py left.avi right.avi rig.json
    joints_of_a_clip.py clip.mkv
"""
import sys

import duoptic

left, right, rig = (sys.argv[1:] + [None, None])[:3]
for frame in duoptic.open(left, right, rig=rig, tracker="body"):
    for person in frame.people:
        hand = person.joints["right_hand"]
        if hand.state == "lost":
            continue
        x, y, z = hand.p_m
        print(f"{frame.t_s:.2f} s: person {person.id}'s right hand at ({x:.2f}, {y:.2f}, {z:.2f}) m +- {1000 * hand.sigma_m:.0f} mm, {hand.state}", end="")
        u, v, w = frame.camera.K @ hand.p_m
        column, row = int(u / w), int(v / w)
        height, width = frame.depth_m.shape
        if 0 <= row < height and 0 <= column < width:
            print(f"; the depth there is {frame.depth_m[row, column]:.2f} m", end="")
        print()
