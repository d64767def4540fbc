"""What the tests are given: the tool, and a folder with clip.mkv, pairs of 320x240 with their rig."""
import os
import subprocess
from pathlib import Path

TOOL = os.environ["DUOPTIC_TOOL"]
CLIP = Path(os.environ["DUOPTIC_CLIP"]) / "clip.mkv"
FRAMES = 20  # of the clip
RIG = Path(os.environ["DUOPTIC_CLIP"]) / "clip" / "calibration_truth.yml"


def tool(*arguments):
    """Runs the tool; gives what it says on stderr where it fails."""
    done = subprocess.run([TOOL, *map(str, arguments)], capture_output=True, text=True)
    return done.stderr if done.returncode else ""
