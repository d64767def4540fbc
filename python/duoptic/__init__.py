"""Two ordinary webcams as a depth camera and a 3D tracker of people.

    import duoptic

    for frame in duoptic.open("clip.mkv", rig="rig.json", tracker="body"):
        print(frame.t_s, frame.depth_m[240, 320], [person.joints["right_hand"].p_m for person in frame.people])

Pixels are (y, x), sizes (width, height); places are metres in the rig frame: x right, y down, z forward from the left camera.
"""

from ._duoptic import (
    Calibration,
    Camera,
    Engine,
    Error,
    Frame,
    Frames,
    Joint,
    Person,
    Pinhole,
    Rig,
    __version__,
    calibrate,
    load_rig,
    open,
    record,
)

__all__ = [
    "Calibration", "Camera", "Engine", "Error", "Frame", "Frames", "Joint", "Person", "Pinhole", "Rig",
    "calibrate", "depth", "load_rig", "open", "record",
]  # fmt: skip


def depth(left, right, *, rig=None, **options):
    """The Frame of one pair: two arrays, uint8 (height, width, 3) RGB or (height, width) gray, or two files.

    rig: a path or a Rig; without it the pair is taken as rectified, and the frame has disparities alone. options: those of Engine,
    of files those of open(). Errors: duoptic.Error.
    """
    if hasattr(left, "shape") and hasattr(right, "shape"):
        if len(left.shape) < 2:
            raise Error(f"left has the shape {tuple(left.shape)}, not (height, width, 3) or (height, width)")
        return Engine((left.shape[1], left.shape[0]), rig=rig, **options)(left, right)
    with open(left, right, rig=rig, **options) as frames:
        for frame in frames:
            return frame
    raise Error(f"{left} gave no pair")
