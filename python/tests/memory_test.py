"""Hundreds of frames need the memory of a few; in a long run (DUOPTIC_LONG) a thousand."""
import gc
import os
import unittest

import duoptic
from given import CLIP


def resident_mb():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


class Memory(unittest.TestCase):
    def test_frames_do_not_add_up(self):
        frames, after_warming_up = 0, None
        most, warm, limit_mb = (1000, 200, 20) if "DUOPTIC_LONG" in os.environ else (400, 100, 8)
        while frames < most:
            for frame in duoptic.open(CLIP, max_disparity=32, threads=2):
                frame.depth_mm, frame.depth_m, frame.points, frame.people
                frames += 1
            del frame
            if frames == warm:
                gc.collect()
                after_warming_up = resident_mb()
        gc.collect()
        # All maps of one frame, its pair and its arrays of floats are 2.5 MB: 300 of them would be 750 MB.
        self.assertLess(resident_mb() - after_warming_up, limit_mb)


if __name__ == "__main__":
    unittest.main()
