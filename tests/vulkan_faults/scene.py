# SPDX-License-Identifier: Apache-2.0
"""What is published and watched while Vulkan fails."""

import numpy as np

import viewloom

WIDTH_PX, HEIGHT_PX = 96, 72
TILE = {"width": 96, "height": 72}
LOSSLESS = {"color": "BAND_ENCODING_ZSTD", "with_depth": True, "with_mask": True}
# Frames by the number that is their capture time: the same surfaces in other colours, and one of
# two layers.
FIRST, SECOND, LAYERED = 1, 2, 3

QUILT = {"columns": 4, "rows": 2, "size": {"width": 384, "height": 144}, "view_cone_rad": 0.3,
         "focal_distance_m": 3.0}
# Turned out of the rows of its source: a device has to walk.
BESIDE = {"world_pose": {"position": {"x": 0.02, "y": 0.03, "z": 0.05},
                         "orientation": {"x": 0.0, "y": 0.0499792, "z": 0.0, "w": 0.9987503}}}
FOV = {"angle_left_rad": -0.4, "angle_right_rad": 0.4, "angle_up_rad": 0.24,
       "angle_down_rad": -0.24}
CALIBRATION = """{"configVersion": "3.0", "serial": "LKG-TEST",
 "pitch": {"value": 49.0}, "slope": {"value": -6.0}, "center": {"value": 0.2},
 "viewCone": {"value": 40.0}, "invView": {"value": 1}, "verticalAngle": {"value": 0},
 "DPI": {"value": 100.0}, "screenW": {"value": 240}, "screenH": {"value": 160},
 "flipImageX": {"value": 0}, "flipImageY": {"value": 0}, "flipSubp": {"value": 0}}"""

# The display that somebody watches all the time.
WATCHED = {"cameras": {"tile_size": {"width": 48, "height": 36}, "cameras": [
    {"pose": {"position": {"x": x, "y": 0.03, "z": 0.02}, "orientation": {"w": 1.0}}, "fov": FOV}
    for x in (-0.03, 0.03)]}}
DISPLAYS = {
    "watched": WATCHED,
    # Takes a second on two cores, so that a server that is told to stop is at work.
    "large": {"quilt": {**QUILT, "columns": 8, "rows": 6, "size": {"width": 960, "height": 540}},
              **BESIDE},
    "sweep": {"quilt": QUILT},
    "quilt": {"quilt": {**QUILT, "columns": 8, "size": {"width": 384, "height": 72}}, **BESIDE},
    "cameras": {"cameras": {"tile_size": TILE, "cameras": [
        {"pose": {"position": {"x": 0.05, "y": 0.02, "z": -0.3}, "orientation": {"w": 1.0}},
         "fov": FOV}]}},
    "stereo": {"stereo": {"eye_size": TILE}, **BESIDE},
    "lenticular": {"lenticular": {"calibration_json": CALIBRATION}, **BESIDE},
    "integral": {"integral": {"panel_size": {"width": 192, "height": 120}, "pixel_pitch_m": 1e-5,
                              "lens_pitch_m": 1.2e-4, "focal_length_m": 3.3e-4, "scale": 4}},
    "depth": {"rgbd": {"view_size": TILE, "depth_bits": 16}, **BESIDE},
    "lens": {"quilt": QUILT, **BESIDE, "effects": {"lens": {"aperture_radius_m": 0.03}}},
    "exact lens": {"quilt": QUILT, **BESIDE, "effects": {
        "lens": {"aperture_radius_m": 0.03, "mode": "GATHER_MODE_EXACT"}}},
    "mirrors": {"quilt": QUILT, **BESIDE, "effects": {"reflection": {"bounces": 2}}},
}


def source(number, is_mirroring=False):
    """A slanted wall with a square before it, and of LAYERED the same once more behind it."""
    y, x = np.mgrid[0:HEIGHT_PX, 0:WIDTH_PX]
    is_square = (20 <= y) & (y < 50) & (30 <= x) & (x < 60)
    wall = np.stack([x * 2, y * 3, np.full_like(x, 90 * number)], axis=-1)
    color = np.where(is_square[..., None], (200, 40, 30), wall).astype(np.uint8)
    depth_m = np.where(is_square, 2.0, 4.0 + 0.01 * x).astype(np.float32)
    words = {"fov_y_rad": 0.9}
    if is_mirroring:
        words["specular"] = np.where(is_square, 200, 40).astype(np.uint8)
        words["roughness"] = np.full((HEIGHT_PX, WIDTH_PX), 30, np.uint8)
    if number == LAYERED:
        return viewloom.Source([color, color], [depth_m, depth_m + np.float32(1)], **words)
    return viewloom.Source(color, depth_m, **words)
