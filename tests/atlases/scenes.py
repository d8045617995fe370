# SPDX-License-Identifier: Apache-2.0
"""What is published and rendered. Together the scenes take every way of a frame through a server:
one layer and several, several sources, a cube map, things that move, mirrors, colour that is seen
through, coarse depth, light without an upper end."""

import json

import numpy as np

from PIL import Image

SIZE_PX = (240, 135)
SYNTHETIC = ["--synthetic", "--size", "240x135", "--fps", "1", "--seconds", "1"]
FOCAL = ["--focal-px", "200"]


def published(folder):
    """Arguments of `viewloom publish` by the name of the stream."""
    color, depth = str(folder / "color.png"), str(folder / "depth.pfm")
    return {
        "one-layer": [*SYNTHETIC, "--layers", "1"],
        "two-layers": [*SYNTHETIC, "--layers", "2"],
        "sources": [*SYNTHETIC, "--sources", "3"],
        "cube": [*SYNTHETIC, "--cube"],
        "mirrors": [*SYNTHETIC, "--mirrors"],
        "motion": [*SYNTHETIC, "--motion"],
        "pattern": ["--pattern", "view-numbers", "--size", "640x360", "--views", "8",
                    "--view-size", "120x68"],
        "coarse": [color, "--depth", str(folder / "codes.png"), "--input", "relative", *FOCAL],
        "glass": [str(folder / "glass.png"), "--depth", depth, "--alpha", "straight", *FOCAL],
        "light": [str(folder / "light.pfm"), "--depth", depth, "--transfer", "linear",
                  "--tone-map", "filmic", *FOCAL],
    }


def rendered(folder):
    """Arguments of `viewloom render`: two frames of a camera that moves to the right past things
    that move, too."""
    return ["--frame", str(folder / "newest.json"), "--before", str(folder / "before.json")]


def write_files(folder):
    """A ball before a wall that leans back, in colours that tell their place."""
    width, height = SIZE_PX
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    from_middle = np.hypot(x - 120, y - 60) / 40
    ball_m = 2.0 - 0.4 * np.sqrt(np.clip(1 - from_middle ** 2, 0, 1))
    depth_m = np.where(from_middle < 1, ball_m, 3.0 + 0.01 * x)
    color = np.stack([7 * x % 256, 5 * y % 256, 3 * (x + y) % 256], axis=-1).astype(np.uint8)
    alpha = np.where(from_middle < 0.7, 128, 255).astype(np.uint8)
    inv_z = 1 / depth_m
    codes = 255 * (inv_z - inv_z.min()) / (inv_z.max() - inv_z.min())
    motion = np.zeros((height, width, 3))
    motion[from_middle < 1] = (0.2, 0.05, 0.0)

    Image.fromarray(color).save(folder / "color.png")
    Image.fromarray(np.dstack([color, alpha])).save(folder / "glass.png")
    Image.fromarray(codes.round().astype(np.uint8)).save(folder / "codes.png")
    _write_pfm(folder / "depth.pfm", depth_m)
    _write_pfm(folder / "light.pfm", color / 64.0)
    _write_pfm(folder / "motion.pfm", motion)
    for number, name in enumerate(("before", "newest")):
        _write_manifest(folder / f"{name}.json", number)


def _write_pfm(path, image):
    """Rows from the top; PFM counts them from the bottom."""
    kind = b"PF" if image.ndim == 3 else b"Pf"
    header = kind + b"\n%d %d\n-1.0\n" % (image.shape[1], image.shape[0])
    path.write_bytes(header + image[::-1].astype("<f4").tobytes())


def _write_manifest(path, number):
    camera = {"pose": {"position": {"x": 0.02 * number}},
              "intrinsics": {"focal_x_px": 200, "focal_y_px": 200, "principal_x_px": 120,
                             "principal_y_px": 67.5}}
    planes = {name: {"file": file} for name, file in
              (("color", "color.png"), ("depth", "depth.pfm"), ("motion", "motion.pfm"))}
    planes["depth"]["depth"] = {"meaning": "DEPTH_MEANING_PLANAR"}
    path.write_text(json.dumps({"number": number + 1, "capture_time_ns": 100_000_000 * number,
                                "sources": [{"camera": camera, "layers": [planes]}]}),
                    encoding="utf-8")
