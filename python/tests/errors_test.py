"""Whatever is wrong is an exception with the tool's line, and the interpreter lives."""
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import duoptic
from given import CLIP, FRAMES, RIG, tool


class Errors(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def check_tools_line(self, call, *arguments):
        said = tool(*arguments)
        with self.assertRaises(duoptic.Error) as raised:
            call()
        self.assertIn(str(raised.exception), said)
        self.assertNotIn("\n", str(raised.exception))
        self.assertTrue(str(raised.exception))
        return raised.exception

    def test_the_tools_line(self):
        gone = self.folder / "gone.mkv"
        error = self.check_tools_line(lambda: duoptic.open(gone), "depth", gone)
        self.assertEqual(error.code, "not found")
        self.check_tools_line(lambda: duoptic.load_rig(gone), "depth", CLIP, "--rig", gone)
        broken = self.folder / "broken.json"
        broken.write_text("{")
        self.check_tools_line(lambda: duoptic.open(CLIP, rig=broken), "depth", CLIP, "--rig", broken)
        clip = CLIP.parent / "clip"
        self.check_tools_line(lambda: duoptic.open(clip / "left.avi", RIG), "depth", clip / "left.avi", RIG)
        nowhere = self.folder / "no" / "people.jsonl"
        error = self.check_tools_line(
            lambda: duoptic.open(CLIP, tracker="body").add_sink(nowhere), "track", CLIP, "-o", nowhere, "--quiet"
        )
        self.assertEqual(error.code, "write failed")

    def test_arrays_that_do_not_fit(self):
        right = np.zeros((240, 320, 3), np.uint8)
        engine = duoptic.Engine((320, 240), rig=RIG)
        for left in (
            np.zeros((240, 321, 3), np.uint8),
            np.zeros((0, 0, 3), np.uint8),
            np.zeros((240, 320, 4), np.uint8),
            np.zeros((240, 320, 3), np.float32),
            np.zeros((240, 320, 3), np.int8),
            np.zeros(7, np.uint8),
            np.zeros((2, 240, 320, 3), np.uint8),
        ):
            with self.assertRaisesRegex(duoptic.Error, r"left is .* of shape"):
                engine(left, right)
            with self.assertRaises(duoptic.Error):
                duoptic.depth(left, right, rig=RIG)
        with self.assertRaisesRegex(duoptic.Error, "right is"):
            engine(right, right[:100])
        for nonsense in (None, "picture", 3):
            with self.assertRaises(TypeError):
                engine(nonsense, right)
        with self.assertRaises(duoptic.Error):  # the rig is of another size
            duoptic.Engine((640, 480), rig=RIG)
        self.assertEqual(engine(right, right).depth_mm.shape[0] > 0, True)

    def test_options_that_do_not_fit(self):
        for options in (
            {"max_disparity": 0},
            {"max_disparity": 100_000},
            {"near_m": -1.0},
            {"near_m": float("nan")},
            {"near_m": 1.0, "max_disparity": 64},
            {"threads": -1},
            {"threads": 100_000},
            {"matcher": "best"},
            {"preset": "best"},
            {"parameters": {"no_such": 1.0}},
            {"engine": "quantum"},
            {"maps": ["depths"]},
            {"tracker": "mind"},
            {"model": "huge"},
            {"every": 0},
            {"first": -1},
            {"layout": "diagonal"},
            {"skew_ms": float("inf")},
        ):
            with self.subTest(options), self.assertRaises(duoptic.Error):
                duoptic.open(CLIP, **options)
        for options in ({"threads": "two"}, {"depht": True}, {"rig": 7}, {"parameters": [1]}, {"maps": 3}):
            with self.subTest(options), self.assertRaises(TypeError):
                duoptic.open(CLIP, **options)
        with self.assertRaisesRegex(duoptic.Error, "needs a rig"):
            duoptic.Engine((320, 240), maps=["depth"])
        with self.assertRaises(duoptic.Error):
            duoptic.Engine((0, 240))

    def test_maps_that_were_not_wanted(self):
        frame = next(duoptic.open(CLIP, maps=["depth"]))
        with self.assertRaisesRegex(duoptic.Error, "confidence"):
            frame.confidence
        picture = np.zeros((240, 320), np.uint8)
        frame = duoptic.depth(picture, picture)
        for name in ("depth_mm", "depth_m", "points"):
            with self.assertRaises(duoptic.Error):
                getattr(frame, name)
        self.assertIsNone(frame.camera)

    def test_the_end_stays_the_end(self):
        frames = duoptic.open(CLIP, every=FRAMES - 1, maps=[])
        self.assertEqual(len(list(frames)), 2)
        self.assertEqual(list(frames), [])
        frames.close()
        for call in (lambda: frames.add_sink(self.folder / "x.jsonl"), lambda: frames.select({"hand": (1, 1)})):
            with self.assertRaises(duoptic.Error):
                call()
        with self.assertRaisesRegex(duoptic.Error, "no kind of output"):
            duoptic.open(CLIP, tracker="body").add_sink("people.docx")
        with self.assertRaisesRegex(duoptic.Error, "give tracker"):
            duoptic.open(CLIP).add_sink("people.jsonl")
        for name in ("people.mp4", "people.mcap"):
            with self.assertRaisesRegex(duoptic.Error, "needs color, views and disparity"):
                duoptic.open(CLIP, tracker="thesis", maps=[]).add_sink(self.folder / name)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_an_output_that_was_not_completed_is_not_there(self):
        frames = duoptic.open(CLIP, tracker="body", model="lite")
        frames.add_sink(self.folder / "people.jsonl")
        next(frames)
        del frames
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_two_threads_at_once_are_told(self):
        frames, said = duoptic.open(CLIP, tracker="body"), []

        def all_of_them():
            try:
                for _ in frames:
                    pass
            except duoptic.Error as error:
                said.append(str(error))

        threads = [threading.Thread(target=all_of_them) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertLess(len(said), 4)
        for line in said:
            self.assertIn("another thread", line)

    def test_calibration_says_what_is_missing(self):
        with self.assertRaises(duoptic.Error):
            duoptic.calibrate(self.folder, board="charuco:9x6", square_mm=30)
        with self.assertRaises(duoptic.Error):
            duoptic.calibrate(CLIP.parent / "clip", board="dominoes", square_mm=30)
        self.check_tools_line(
            lambda: duoptic.calibrate(CLIP, board="charuco:9x6", square_mm=30), "calibrate", CLIP, "--board", "charuco:9x6",
            "--square-mm", "30", "-o", self.folder / "rig.json", "--quiet"
        )  # fmt: skip


if __name__ == "__main__":
    unittest.main()
