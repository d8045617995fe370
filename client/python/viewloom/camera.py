# SPDX-License-Identifier: Apache-2.0
"""Cameras from angles, intrinsics and matrices."""

from __future__ import annotations

import math
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from viewloom.errors import BadInput
from viewloom.v1 import geometry_pb2

PoseLike = Union[geometry_pb2.Pose, NDArray[Any], Sequence[Sequence[float]], None]
_ROTATION_TOLERANCE = 1e-3  # as the server's, of the quaternion's length


def _four_numbers(values: Sequence[float], field: str, names: str) -> list[float]:
    numbers = np.asarray(values)
    if numbers.shape != (4,) or numbers.dtype.kind not in "iuf":
        raise BadInput(field, f"is {values!r}, must be four numbers: {names}")
    return [float(number) for number in numbers]


def _fov(angles_rad: Sequence[float]) -> geometry_pb2.Fov:
    names = "left, right, up, down, rad from the view axis, negative to the left and downwards"
    left, right, up, down = _four_numbers(angles_rad, "fov", names)
    return geometry_pb2.Fov(angle_left_rad=left, angle_right_rad=right, angle_up_rad=up,
                            angle_down_rad=down)


def _symmetric_fov(fov_y_rad: float, width_px: int, height_px: int) -> geometry_pb2.Fov:
    if not 0 < fov_y_rad < math.pi:
        raise BadInput("fov_y_rad", f"is {fov_y_rad}, must lie between 0 and pi (radians)")
    half_y_rad = fov_y_rad / 2
    half_x_rad = math.atan(math.tan(half_y_rad) * width_px / height_px)
    return _fov([-half_x_rad, half_x_rad, half_y_rad, -half_y_rad])


def _intrinsics(values: Sequence[float]) -> geometry_pb2.Intrinsics:
    names = "focal x, focal y, principal x, principal y, px of the depth plane"
    focal_x, focal_y, principal_x, principal_y = _four_numbers(values, "intrinsics", names)
    return geometry_pb2.Intrinsics(focal_x_px=focal_x, focal_y_px=focal_y,
                                   principal_x_px=principal_x, principal_y_px=principal_y)


def _quaternion(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """x, y, z, w of a rotation matrix."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    trace = xx + yy + zz
    # 4 q_i q_j. The row of the largest component, divided by it, loses least to rounding.
    products = np.array([[1 + 2 * xx - trace, yx + xy, zx + xz, zy - yz],
                         [yx + xy, 1 + 2 * yy - trace, zy + yz, xz - zx],
                         [zx + xz, zy + yz, 1 + 2 * zz - trace, yx - xy],
                         [zy - yz, xz - zx, yx - xy, 1 + trace]])
    row = products[int(np.argmax(products.diagonal()))]
    return np.asarray(row / np.linalg.norm(row), np.float64)


def pose_from(pose: PoseLike, field: str = "pose") -> geometry_pb2.Pose:
    """A Pose as it is, or from a 4x4 camera-to-world matrix (metres, +y up, looking along -z)."""
    if pose is None:
        return geometry_pb2.Pose()
    if isinstance(pose, geometry_pb2.Pose):
        return pose
    matrix = np.asarray(pose)
    if matrix.shape != (4, 4) or matrix.dtype.kind not in "iuf":
        raise BadInput(field, f"is {matrix.dtype} of shape {matrix.shape}, must be a 4x4 matrix of "
                       "numbers, camera to world, or a Pose")
    matrix = matrix.astype(np.float64)
    rotation = matrix[:3, :3]
    error = np.abs(rotation @ rotation.T - np.eye(3)).max()
    if not error <= _ROTATION_TOLERANCE or np.linalg.det(rotation) < 0:
        raise BadInput(field, "must turn without scaling, shearing or mirroring: its upper left "
                       "3x3 is no rotation")
    if not np.array_equal(matrix[3], [0, 0, 0, 1]):
        raise BadInput(field, f"ends with the row {matrix[3].tolist()}, must end with 0 0 0 1: "
                       "points are columns")
    x, y, z, w = _quaternion(rotation)
    return geometry_pb2.Pose(position=dict(zip("xyz", matrix[:3, 3])),
                             orientation={"x": x, "y": y, "z": z, "w": w})


def make_camera(size_px: tuple[int, int], *, fov_y_rad: Optional[float] = None,
                fov: Optional[Sequence[float]] = None,
                intrinsics: Optional[Sequence[float]] = None, pose: PoseLike = None,
                without_projection: bool = False) -> geometry_pb2.Camera:
    """A pinhole for a plane of (width, height) px, from exactly one of its three projections.

    A cube map is the camera without projection.
    """
    given = [name for name, value in (("fov_y_rad", fov_y_rad), ("fov", fov),
                                      ("intrinsics", intrinsics)) if value is not None]
    if without_projection and given:
        raise BadInput(given[0], "is given; accepted: none, as each face of a cube map is 90 "
                       "degrees wide")
    if not without_projection and len(given) != 1:
        raise BadInput("camera", f"got {' and '.join(given) or 'no projection'}; accepted: one of "
                       "fov_y_rad, fov and intrinsics")
    camera = geometry_pb2.Camera(pose=pose_from(pose))
    if fov_y_rad is not None:
        camera.fov.CopyFrom(_symmetric_fov(fov_y_rad, *size_px))
    elif fov is not None:
        camera.fov.CopyFrom(_fov(fov))
    elif intrinsics is not None:
        camera.intrinsics.CopyFrom(_intrinsics(intrinsics))
    return camera
