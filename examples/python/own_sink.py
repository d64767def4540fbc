"""An output of one's own is the body of the loop, beside those that the library has:
    own_sink.py clip.mkv people.csv
"""
import sys

import duoptic

nearest_m = float("inf")
with duoptic.open(sys.argv[1], tracker="body") as frames:
    frames.add_sink(sys.argv[2])
    for frame in frames:
        for person in frame.people:
            for joint in person.joints.values():
                if joint.state == "seen":
                    nearest_m = min(nearest_m, joint.p_m[2])
print(f"the nearest joint was {nearest_m:.2f} m away")
