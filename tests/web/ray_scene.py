# SPDX-License-Identifier: Apache-2.0
"""A scene that is known exactly: balls before a wall, on a floor. What any eye sees of it, with
depth. The oracle of tests that reproject pictures."""
import math

import numpy as np

WALL_M = 8.0    # away from the display, along -z
FLOOR_M = -1.2  # y
BALLS = ((-0.9, 0.0, -3.2, 0.55), (0.8, -0.35, -2.6, 0.4), (0.1, 0.55, -5.0, 0.7),
         (1.6, 0.2, -5.5, 0.6), (-1.9, -0.5, -5.8, 0.5))  # x, y, z, radius, m
COLOURS = ((0.85, 0.3, 0.25), (0.3, 0.75, 0.4), (0.3, 0.45, 0.9), (0.9, 0.75, 0.3),
           (0.7, 0.35, 0.8))
FOCAL_M = 4.0  # of the stream's defaults
FOV_Y_RAD = 2 * math.atan(0.45)


def rotation(quaternion):
    """The matrix of a quaternion x, y, z, w."""
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Eye:
    """A pinhole: pose and intrinsics in px of its image."""

    def __init__(self, position, orientation, focal, principal):
        self.position = np.array(position, float)
        self.orientation = tuple(orientation)
        self.focal = tuple(focal)
        self.principal = tuple(principal)

    @staticmethod
    def straight(x_m, width, height, y_m=0.0, z_m=0.0):
        """Frames the display's rectangle on the focal plane from a place in front of it."""
        half_height_m = FOCAL_M * math.tan(FOV_Y_RAD / 2)
        away_m = FOCAL_M + z_m
        focal = 0.5 * height * away_m / half_height_m
        return Eye((x_m, y_m, z_m), (0, 0, 0, 1), (focal, focal),
                   (0.5 * width - x_m * focal / away_m, 0.5 * height + y_m * focal / away_m))

    @staticmethod
    def of_message(camera, width, height):
        """A Camera of the protocol as JSON; without a projection, as straight()."""
        pose = camera.get("pose", {})
        position = [pose.get("position", {}).get(axis, 0) for axis in "xyz"]
        turned = pose.get("orientation", {"w": 1})
        orientation = [turned.get(axis, 0) for axis in "xyzw"]
        if "fov" not in camera:
            return Eye.straight(position[0], width, height, *position[1:])
        left, right, up, down = (math.tan(camera["fov"][f"angle_{side}_rad"])
                                 for side in ("left", "right", "up", "down"))
        focal = (width / (right - left), height / (up - down))
        return Eye(position, orientation, focal, (-left * focal[0], up * focal[1]))

    def message(self):
        """As a layout lists it."""
        x, y, z = (float(value) for value in self.position)
        qx, qy, qz, qw = (float(value) for value in self.orientation)
        return {"pose": {"position": {"x": x, "y": y, "z": z},
                         "orientation": {"x": qx, "y": qy, "z": qz, "w": qw}},
                "intrinsics": {"focal_x_px": self.focal[0], "focal_y_px": self.focal[1],
                               "principal_x_px": self.principal[0],
                               "principal_y_px": self.principal[1]}}


def _checks(a, b, size):
    """Smooth squares, which JPEG keeps."""
    waves = np.sin(np.pi * a / size) * np.sin(np.pi * b / size)
    return 0.5 + 0.5 * np.clip(3 * waves, -1, 1)


def look(eye, width, height, time_s=0.0):
    """(uint8[height][width][3], float32[height][width]): colour, and 1/Z in 1/m."""
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = np.stack([(u - eye.principal[0]) / eye.focal[0], -(v - eye.principal[1]) / eye.focal[1],
                     -np.ones_like(u)], -1)
    rays = rays @ rotation(eye.orientation).T
    origin = eye.position
    # A ray is origin + t ray, where t is Z of the eye.
    with np.errstate(divide="ignore", invalid="ignore"):
        nearest = (-WALL_M - origin[2]) / rays[..., 2]
        nearest = np.where(nearest > 0, nearest, np.inf)
        floor = (FLOOR_M - origin[1]) / rays[..., 1]
    is_floor = (floor > 0) & (floor < nearest)
    nearest = np.where(is_floor, floor, nearest)
    point = origin + rays * np.where(np.isfinite(nearest), nearest, 0)[..., None]
    checks = np.where(is_floor, _checks(point[..., 0], point[..., 2], 0.5),
                      _checks(point[..., 0], point[..., 1], 0.7))
    colour = np.stack([0.25 + 0.5 * checks, 0.3 + 0.4 * checks, 0.5 - 0.2 * checks], -1)
    for (x, y, z, radius), base in zip(BALLS, COLOURS):
        centre = np.array([x + 0.5 * math.sin(time_s), y, z]) - origin
        a = (rays * rays).sum(-1)
        b = rays @ centre
        inside = b * b - a * (centre @ centre - radius * radius)
        t = (b - np.sqrt(np.maximum(inside, 0))) / a
        is_hit = (inside > 0) & (t > 0) & (t < nearest)
        normal = (rays * t[..., None] - centre) / radius
        stripes = 0.6 + 0.4 * np.sin(9 * normal[..., 1]) * np.sin(7 * normal[..., 0])
        light = 0.35 + 0.65 * np.clip(normal @ np.array([0.4, 0.7, 0.6]), 0, 1)
        colour = np.where(is_hit[..., None], np.array(base) * (stripes * light)[..., None], colour)
        nearest = np.where(is_hit, t, nearest)
    inv_z = np.where(np.isfinite(nearest), 1 / np.maximum(nearest, 1e-6), 0)
    return (255 * np.clip(colour, 0, 1) + 0.5).astype(np.uint8), inv_z.astype(np.float32)


def psnr(a, b):
    """Of two pictures, dB."""
    error = np.mean((a.astype(float) - b.astype(float)) ** 2)
    return 99.0 if error == 0 else 10 * math.log10(255 ** 2 / error)
