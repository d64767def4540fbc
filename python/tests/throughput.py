"""CPU time of tracking a recording in Python, beside the tool's: throughput.py TOOL [FRAMES [ROUNDS]]

All run in processes of their own, by turns, and write the same JSON lines; Python also looks at the depth and the people of every
frame, and with all maps has colour, both views and disparities made, too. Medians of whole processes, the interpreter's start among them.
"""
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

LOOP = """
import sys, duoptic
with duoptic.open(sys.argv[1], tracker="body", maps=["depth"] if sys.argv[3] == "depth" else None) as frames:
    frames.add_sink(sys.argv[2])
    for frame in frames:
        frame.depth_mm, frame.people
"""


def cpu_s(command):
    """User and system time of a command and its threads."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def main():
    tool = sys.argv[1]
    frames, rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 200, int(sys.argv[3]) if len(sys.argv) > 3 else 7
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        clip, recording = folder / "clip", folder / "clip.mkv"
        cpu_s([tool, "synth", "--script", "wave", "--frames", str(frames), "--quiet", "-o", clip])
        cpu_s([tool, "record", clip / "left.avi", clip / "right.avi", "--rig", clip / "calibration_truth.yml", "-o", recording, "--quiet"])
        commands = {
            "tool": [tool, "track", recording, "-o", folder / "tool.jsonl", "--quiet"],
            "python": [sys.executable, "-B", "-c", LOOP, recording, folder / "python.jsonl", "depth"],
            "python, all maps": [sys.executable, "-B", "-c", LOOP, recording, folder / "all.jsonl", "all"],
        }
        took_s = {name: [] for name in commands}
        for _ in range(rounds):
            for name, command in commands.items():
                took_s[name].append(cpu_s(command))
        assert len({(folder / f"{name}.jsonl").read_bytes() for name in ("tool", "python", "all")}) == 1
    medians_s = {name: statistics.median(times_s) for name, times_s in took_s.items()}
    for name, time_s in medians_s.items():
        print(f"{name:16}  {1000 * time_s / frames:5.1f} ms of CPU time a frame: {100 * medians_s['tool'] / time_s:5.1f} % of the tool's throughput")


if __name__ == "__main__":
    main()
