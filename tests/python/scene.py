# SPDX-License-Identifier: Apache-2.0
"""Known pictures: noise that no interpolation reproduces, before a step in depth."""

import math

import numpy as np

import viewloom

WIDTH_PX, HEIGHT_PX = 160, 120
FOV_Y_RAD = 2 * math.atan(0.6)  # so half the width is 0.8 of the distance
NEAR_M, FAR_M = 2.0, 4.0


def noise_color(seed=1):
    """uint8[HEIGHT_PX][WIDTH_PX][3]."""
    random = np.random.default_rng(seed)
    return random.integers(0, 256, (HEIGHT_PX, WIDTH_PX, 3), np.uint8)


def smooth_color():
    """uint8[HEIGHT_PX][WIDTH_PX][3] that JPEG keeps: slow ramps."""
    y, x = np.mgrid[0:HEIGHT_PX, 0:WIDTH_PX]
    return np.stack([40 + x, 30 + y, 220 - (x + y) // 2], axis=-1).astype(np.uint8)


def step_depth():
    """float32[HEIGHT_PX][WIDTH_PX], metres: a square before a wall."""
    depth_m = np.full((HEIGHT_PX, WIDTH_PX), FAR_M, np.float32)
    depth_m[40:80, 60:100] = NEAR_M
    return depth_m


def source(color, depth_m, **more):
    return viewloom.Source(color, depth_m, fov_y_rad=FOV_Y_RAD, **more)


def fov_mapping():
    """The source's field of view, for a Display written as a mapping."""
    return {"angle_left_rad": -math.atan(0.8), "angle_right_rad": math.atan(0.8),
            "angle_up_rad": math.atan(0.6), "angle_down_rad": -math.atan(0.6)}


def own_place():
    """The display of one view, at the source's own pose."""
    return cameras([0.0])


def cameras(eyes_m, columns=0):
    """The source's pinhole, moved sideways to each eye."""
    return {"cameras": {"tile_size": {"width": WIDTH_PX, "height": HEIGHT_PX}, "columns": columns,
                        "cameras": [{"pose": {"position": {"x": x}}, "fov": fov_mapping()}
                                    for x in eyes_m]}}


def quilt(columns, rows, **more):
    """Tiles of the source's size, focused on the wall."""
    return {"quilt": {"columns": columns, "rows": rows, "view_cone_rad": 0.3,
                      "size": {"width": WIDTH_PX * columns, "height": HEIGHT_PX * rows},
                      "focal_distance_m": FAR_M, **more}}
