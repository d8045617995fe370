# SPDX-License-Identifier: Apache-2.0
"""How surfaces mirror and move, from numpy arrays to planes of the wire."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewloom.arrays import as_array, shape_text
from viewloom.errors import BadInput
from viewloom.planes import WirePlane
from viewloom.v1 import frame_pb2

_SPACES = {"camera": frame_pb2.NORMAL_SPACE_CAMERA, "world": frame_pb2.NORMAL_SPACE_WORLD}


def _checked(value: Any, field: str, accepted: str, channels: tuple[int, ...]) -> NDArray[Any]:
    """channels: how many a px may have; 0 = an array of two dimensions."""
    array = as_array(value, field, accepted)
    channel_count = array.shape[2] if array.ndim == 3 else 0
    if array.ndim not in (2, 3) or channel_count not in channels or array.size == 0:
        raise BadInput(field, f"has the shape {shape_text(array)}, must be {accepted}")
    return array


def _plane(kind: int, encoding: int, samples: NDArray[Any], **more: Any) -> WirePlane:
    return WirePlane(frame_pb2.Plane(
        kind=kind, encoding=encoding,  # type: ignore[arg-type]
        size={"width": samples.shape[1], "height": samples.shape[0]}, **more), samples)


def normal_plane(normal: Any, field: str, space: str) -> WirePlane:
    """float or uint8 [height][width][3], or uint16 [height][width][2]: an octahedron."""
    accepted = ("floats or uint8 of shape (height, width, 3), or uint16 of shape "
                "(height, width, 2), top row first")
    array = _checked(normal, field, accepted, (2, 3))
    if space not in _SPACES:
        raise BadInput("normal_space", f"is {space!r}, must be one of {', '.join(_SPACES)}")
    if array.dtype.kind == "f" and array.shape[2] == 3:
        encoding, wire_type = frame_pb2.PLANE_ENCODING_XYZ16F, "<f2"
    elif array.dtype == np.uint8 and array.shape[2] == 3:
        encoding, wire_type = frame_pb2.PLANE_ENCODING_XYZ8, "u1"
    elif array.dtype == np.uint16 and array.shape[2] == 2:
        encoding, wire_type = frame_pb2.PLANE_ENCODING_OCT16, "<u2"
    else:
        raise BadInput(field, f"has samples of {array.dtype}, must be {accepted}")
    with np.errstate(over="ignore"):  # what is too long for binary16 has no direction
        samples = np.ascontiguousarray(array.astype(wire_type, copy=False))
    return _plane(frame_pb2.PLANE_KIND_NORMAL, encoding, samples, normal_space=_SPACES[space])


def motion_plane(motion: Any, field: str) -> WirePlane:
    """float [height][width][3], m/s along the world's axes."""
    accepted = "floats of shape (height, width, 3), m/s, top row first"
    array = _checked(motion, field, accepted, (3,))
    if array.dtype.kind != "f":
        raise BadInput(field, f"has samples of {array.dtype}, must be {accepted}")
    with np.errstate(over="ignore"):  # what is too fast for binary16 stands, and is counted
        samples = np.ascontiguousarray(array.astype("<f2", copy=False))
    return _plane(frame_pb2.PLANE_KIND_MOTION, frame_pb2.PLANE_ENCODING_XYZ16F, samples)


def _shares(array: NDArray[Any], field: str, accepted: str) -> NDArray[Any]:
    """Of uint8 v / 255, or floats 0..1."""
    if array.dtype == np.uint8:
        return np.ascontiguousarray(array)
    if array.dtype.kind != "f":
        raise BadInput(field, f"has samples of {array.dtype}, must be {accepted}")
    low, high = array.min(), array.max()
    if not (low >= 0 and high <= 1):  # NaN compares false
        raise BadInput(field, f"holds {low if not low >= 0 else high}, must lie in 0..1")
    return np.ascontiguousarray(np.rint(array * 255).astype(np.uint8))


def roughness_plane(roughness: Any, field: str) -> WirePlane:
    """uint8 (v / 255) or float 0..1, [height][width]."""
    accepted = "uint8 or floats of shape (height, width), top row first"
    samples = _shares(_checked(roughness, field, accepted, (0,)), field, accepted)
    return _plane(frame_pb2.PLANE_KIND_ROUGHNESS, frame_pb2.PLANE_ENCODING_R8, samples)


def specular_plane(specular: Any, field: str) -> WirePlane:
    """uint8 (v / 255) or float 0..1, [height][width] or [height][width][3]."""
    accepted = "uint8 or floats of shape (height, width) or (height, width, 3), top row first"
    samples = _shares(_checked(specular, field, accepted, (0, 3)), field, accepted)
    encoding = (frame_pb2.PLANE_ENCODING_RGB8 if samples.ndim == 3
                else frame_pb2.PLANE_ENCODING_R8)
    return _plane(frame_pb2.PLANE_KIND_SPECULAR, encoding, samples)
