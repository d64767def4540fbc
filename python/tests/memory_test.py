"""A thousand frames need the memory of a few."""
import gc
import unittest

import duoptic
from given import CLIP


def resident_mb():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


class Memory(unittest.TestCase):
    def test_a_thousand_frames_do_not_add_up(self):
        frames, after_warming_up = 0, None
        while frames < 1000:
            for frame in duoptic.open(CLIP, max_disparity=32, threads=2):
                frame.depth_mm, frame.depth_m, frame.points, frame.people
                frames += 1
            del frame
            if frames == 200:
                gc.collect()
                after_warming_up = resident_mb()
        gc.collect()
        # All maps of one frame, its pair and its arrays of floats are 2.5 MB: 800 of them would be 2 GB.
        self.assertLess(resident_mb() - after_warming_up, 20)


if __name__ == "__main__":
    unittest.main()
