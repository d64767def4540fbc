"""Regions of people and hands in rendered clips, cut out by what the clips' truth says: what the ranges are measured on."""
import json
import subprocess

import numpy as np


def frames(clip):
    """RGB pictures of the left camera, and the truth's joints of each."""
    truth = json.load(open(f"{clip}/truth.json"))
    width, height = truth["meta"]["width"], truth["meta"]["height"]
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", f"{clip}/left.avi", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    pictures = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3)
    return list(zip(pictures, (frame["joints"] for frame in truth["frames"])))


def cut(picture, center, size, angle, pixels, outside=None):
    """The turned square around `center` of `size` px as pixels x pixels, bilinear; beyond the picture its edge, or `outside`."""
    step = size / pixels
    grid = (np.arange(pixels) + 0.5 - pixels / 2) * step
    u, v = np.meshgrid(grid, grid)
    x = center[0] + u * np.cos(angle) - v * np.sin(angle) - 0.5
    y = center[1] + u * np.sin(angle) + v * np.cos(angle) - 0.5
    height, width = picture.shape[:2]
    inside = (x > -1) & (x < width) & (y > -1) & (y < height)
    x, y = np.clip(x, 0, width - 1), np.clip(y, 0, height - 1)
    left, top = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    fx, fy = (x - left)[..., None], (y - top)[..., None]
    part = lambda dy, dx: picture[top + dy, left + dx].astype(np.float32)
    out = (part(0, 0) * (1 - fx) + part(0, 1) * fx) * (1 - fy) + (part(1, 0) * (1 - fx) + part(1, 1) * fx) * fy
    if outside is not None:
        out[~inside] = outside
    return out


def body_region(joints):
    """As the detector's two points make it: centre between the hips, a circle around a standing person, a quarter more."""
    at = {name: np.array(joint["uv_left"]) for name, joint in joints.items() if joint["uv_left"]}
    hips = (at["left_hip"] + at["right_hip"]) / 2
    up = (at["left_shoulder"] + at["right_shoulder"]) / 2 - hips
    return hips, 2 * 1.9 * np.hypot(*up) * 1.25, np.arctan2(up[0], -up[1])


def hand_region(joints, side):
    """30 cm around a point 4 cm beyond the middle of the hand, the forearm upright."""
    wrist, elbow = joints[f"{side}_wrist"], joints[f"{side}_elbow"]
    if not (wrist["uv_left"] and wrist["vis_left"] and joints[f"{side}_hand"]["vis_left"] and elbow["uv_left"]):
        return None
    along = np.array(wrist["xyz"]) - np.array(elbow["xyz"])
    along *= 0.085 / np.linalg.norm(along)
    px_per_m = 557 / wrist["xyz"][2]
    across = along[:2] * px_per_m
    return np.array(wrist["uv_left"]) + across, 0.30 * px_per_m, np.arctan2(across[0], -across[1])


def samples(kind, clip, pixels, count, seed=1):
    """`count` inputs of a model, in bytes, from frames spread over a clip; regions moved, turned and scaled by chance."""
    chance = np.random.default_rng(seed)
    all_frames = frames(clip)
    out = []
    for i in np.linspace(0, len(all_frames) - 1, count).astype(int):
        picture, joints = all_frames[i]
        height, width = picture.shape[:2]
        if kind == "person":
            zoom = chance.choice([1, 1, 0.6, 0.4])
            center = np.array([width / 2, height / 2]) + (1 - zoom) * chance.uniform(-0.5, 0.5, 2) * (width, height)
            out.append(cut(picture, center, zoom * max(width, height), 0, pixels, outside=0))
            continue
        region = body_region(joints) if kind == "body" else hand_region(joints, chance.choice(["left", "right"]))
        if region:
            center, size, angle = region
            center = center + chance.normal(0, 0.03, 2) * size
            out.append(cut(picture, center, size * 2 ** chance.normal(0, 0.15), angle + chance.normal(0, 0.15), pixels))
    return out
