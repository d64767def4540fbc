"""Frames in Python are those of the tool, bit for bit, and stay what they are."""
import itertools
import json
import struct
import tempfile
import threading
import unittest
import zlib
from pathlib import Path

import numpy as np

import duoptic
from given import CLIP, FRAMES, RIG, tool


def png16(path):
    """The values of a gray PNG of 16 bits without interlacing, read by the standard (ISO 15948)."""
    bytes_, at, packed, size = path.read_bytes(), 8, b"", None
    while at < len(bytes_):
        length, kind = struct.unpack(">I4s", bytes_[at : at + 8])
        body = bytes_[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert (depth, color) == (16, 0)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    rows, out, above = zlib.decompress(packed), [], bytes(2 * width)
    for y in range(height):
        kind, row = rows[y * (2 * width + 1)], bytearray(rows[y * (2 * width + 1) + 1 : (y + 1) * (2 * width + 1)])
        for x in range(len(row)):
            a, b, c = row[x - 2] if x > 1 else 0, above[x], above[x - 2] if x > 1 else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[x] = (row[x] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        out.append(np.frombuffer(bytes(row), ">u2"))
        above = row
    return np.array(out)


class Frames(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_depth_and_points_are_the_tools(self):
        self.assertEqual(tool("depth", CLIP, "--near", "0.5", "--every", "10", "--quiet", "-o", self.folder), "")
        numbers = []
        for frame in duoptic.open(CLIP, every=10):
            numbers.append(frame.number)
            folder = self.folder / f"frame_{frame.number:06}"
            np.testing.assert_array_equal(png16(folder / "depth.png"), frame.depth_mm)
            header, _, body = (folder / "cloud.ply").read_bytes().partition(b"end_header\n")
            vertices = np.frombuffer(body, [("p", "<f4", 3), ("color", "u1", 3)])
            known = ~np.isnan(frame.points[..., 2])
            self.assertGreater(known.mean(), 0.5)
            np.testing.assert_array_equal(vertices["p"], frame.points[known])
            np.testing.assert_array_equal(vertices["color"], frame.color[known])
        self.assertEqual(numbers, [0, 10])

    def test_people_are_the_tools(self):
        theirs, ours = self.folder / "theirs.jsonl", self.folder / "ours.jsonl"
        self.assertEqual(tool("track", CLIP, "--whole", "-o", theirs, "--csv", self.folder / "theirs.csv", "--quiet"), "")
        frames = duoptic.open(CLIP, tracker="body")
        frames.add_sink(ours)
        frames.add_sink(self.folder / "ours.csv", axes="opencv")
        mine = list(frames)
        self.assertEqual(ours.read_bytes(), theirs.read_bytes())
        self.assertEqual((self.folder / "ours.csv").read_bytes(), (self.folder / "theirs.csv").read_bytes())
        lines = [json.loads(line) for line in theirs.read_text().splitlines()][1:]
        self.assertEqual(len(lines), len(mine))
        seen = 0
        for line, frame in zip(lines, mine):
            self.assertEqual([person["id"] for person in line["people"]], [person.id for person in frame.people])
            for theirs_person, person in zip(line["people"], frame.people):
                self.assertEqual(list(theirs_person["joints"]), list(person.joints))
                for name, joint in person.joints.items():
                    told = theirs_person["joints"][name]
                    self.assertEqual(told["state"], joint.state)
                    self.assertAlmostEqual(told["sigma_m"], joint.sigma_m, delta=0.500001e-4)
                    if joint.state != "lost":
                        # Files have the bones' lengths that were learnt later, and their directions.
                        np.testing.assert_allclose(told["p_in_rig_m"], joint.p_m, atol=0.06, rtol=0)
                        seen += 1
                for side, (above, below) in itertools.product(("left", "right"), (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))):
                    names = f"{side}_{above}", f"{side}_{below}"
                    if "lost" in (person.joints[name].state for name in names):
                        continue
                    theirs_bone = np.subtract(*(theirs_person["joints"][name]["p_in_rig_m"] for name in names))
                    bone = np.subtract(*(person.joints[name].p_m for name in names))
                    unlike = theirs_bone / np.linalg.norm(theirs_bone) - bone / np.linalg.norm(bone)
                    self.assertLess(np.linalg.norm(unlike), 2e-3, names)
        self.assertGreater(seen, 100)

    def test_fingers_and_pinches(self):
        for frame in itertools.islice(duoptic.open(CLIP, tracker="body_hands"), 3):
            for person in frame.people:
                self.assertEqual((person.skeleton, len(person.joints)), ("body_hands", 61))
                for side in ("left", "right"):
                    tips = [person.joints[f"{side}_{finger}_tip"] for finger in ("thumb", "index")]
                    pinch = person.pinch_m(side)
                    states = {tip.state for tip in tips}
                    if "lost" in states or "seen" not in states:
                        self.assertIsNone(pinch)
                        continue
                    distance, sigma = pinch
                    self.assertAlmostEqual(distance, np.linalg.norm(np.subtract(tips[0].p_m, tips[1].p_m)))
                    self.assertGreater(sigma, 0)
                with self.assertRaisesRegex(duoptic.Error, "neither 'left' nor 'right'"):
                    person.pinch_m("middle")

    def test_an_arm_that_is_clicked_is_the_tools(self):
        truth = json.loads((CLIP.parent / "clip" / "truth.json").read_text())["frames"][0]["joints"]
        parts = ("hand", "elbow", "shoulder")
        side = next(s for s in ("right", "left") if all(truth[f"{s}_{part}"]["vis_left"] for part in parts))
        at = {part: tuple(truth[f"{side}_{part}"]["uv_left"]) for part in parts}
        options = [word for part, (x, y) in at.items() for word in ("--select", f"{part}={x:.6f},{y:.6f}")]
        self.assertEqual(tool("track", CLIP, "--arm", side, *options, "-o", self.folder / "theirs.jsonl", "--quiet"), "")
        with duoptic.open(CLIP, tracker="arm") as frames:
            next(frames)
            people = frames.select(at, arm=side)
            self.assertEqual([person.skeleton for person in people], [f"{side}_arm"])
            frames.add_sink(self.folder / "ours.jsonl")
            for _ in frames:
                pass
        self.assertEqual((self.folder / "ours.jsonl").read_bytes(), (self.folder / "theirs.jsonl").read_bytes())

    def test_maps_are_views_that_stay_what_they_are(self):
        kept, copies = [], []
        for frame in duoptic.open(CLIP):
            self.assertFalse(frame.depth_mm.flags.owndata)
            self.assertFalse(frame.depth_mm.flags.writeable)
            self.assertTrue(np.shares_memory(frame.depth_mm, frame.depth_mm))
            kept.append((frame.depth_mm, frame.color))
            copies.append((frame.depth_mm.copy(), frame.color.copy()))
        del frame
        for (depth, color), (depth_then, color_then) in zip(kept, copies):
            np.testing.assert_array_equal(depth, depth_then)
            np.testing.assert_array_equal(color, color_then)
        self.assertGreater(np.count_nonzero(kept[0][0] != kept[-1][0]), 0)

    def test_floats_are_the_whole_numbers(self):
        frame = next(duoptic.open(CLIP))
        known = frame.depth_mm > 0
        np.testing.assert_array_equal(np.isnan(frame.depth_m), ~known)
        np.testing.assert_array_equal(np.rint(frame.depth_m[known] * 1000), frame.depth_mm[known])
        known = frame.disparity_q4 != 65535
        np.testing.assert_array_equal(frame.disparity[known], frame.disparity_q4[known] / np.float32(16))
        z = frame.camera.focal_px * frame.camera.baseline_m / frame.disparity[known & (frame.disparity_q4 > 0)]
        np.testing.assert_allclose(frame.points[known & (frame.disparity_q4 > 0)][:, 2], z, rtol=1e-5)

    def test_arrays_give_the_frames_of_files(self):
        rig = duoptic.load_rig(RIG)
        for frame in duoptic.open(CLIP, every=FRAMES - 1):
            again = duoptic.depth(frame.raw_left, frame.raw_right, rig=rig)
            np.testing.assert_array_equal(again.depth_mm, frame.depth_mm)
        flipped = np.ascontiguousarray(frame.raw_left[:, ::-1])[:, ::-1]  # strides are not C's
        np.testing.assert_array_equal(duoptic.depth(flipped, frame.raw_right, rig=rig).depth_mm, frame.depth_mm)

    def test_a_recording_of_a_recording_has_the_same_frames(self):
        self.assertEqual(duoptic.record(CLIP, None, self.folder / "again.mkv"), FRAMES)
        first, again = (next(duoptic.open(path)) for path in (CLIP, self.folder / "again.mkv"))
        np.testing.assert_array_equal(first.depth_mm, again.depth_mm)
        rig = duoptic.open(self.folder / "again.mkv").rig
        rig.save(self.folder / "rig.json")
        np.testing.assert_array_equal(duoptic.load_rig(self.folder / "rig.json").left.K, rig.left.K)

    def test_other_threads_go_on_meanwhile(self):
        turns, done = [0], threading.Event()

        def count():
            while not done.is_set():
                turns[0] += 1

        other = threading.Thread(target=count)
        self.addCleanup(done.set)  # also where the engine fails
        other.start()
        before = turns[0]
        engine = duoptic.Engine((320, 240), rig=RIG, engine="ref", threads=1)  # slow
        frame = next(duoptic.open(CLIP))
        start = turns[0]
        engine(frame.raw_left, frame.raw_right)
        during = turns[0] - start
        done.set()
        other.join()
        self.assertGreater(during, 1000)
        self.assertGreaterEqual(start, before)


if __name__ == "__main__":
    unittest.main()
