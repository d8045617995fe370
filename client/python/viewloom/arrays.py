# SPDX-License-Identifier: Apache-2.0
"""Which arrays are taken as colour and depth, and what to do about those that are not."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewloom.errors import BadInput

_COLOR = "uint8 or floats of shape (height, width, 3 or 4), top row first"
_DEPTH = "floats or uint16 of shape (height, width), top row first"
_INTEGERS = "iu"


def shape_text(array: NDArray[Any]) -> str:
    """ "270x480x3"."""
    return "x".join(map(str, array.shape)) or "a single number"


def sample_type(array: NDArray[Any]) -> str:
    """ "u1", "f4": kind and bytes, whatever the order of the bytes."""
    return f"{array.dtype.kind}{array.dtype.itemsize}"


def as_array(value: Any, field: str, accepted: str) -> NDArray[Any]:
    """An array, or what numpy makes one of: a tensor on the CPU, a Pillow image. BadInput."""
    if isinstance(value, np.ma.MaskedArray):
        raise BadInput(field, "is a masked array: say what stands where it is masked, as "
                       f"{field}.filled(numpy.nan)")
    if isinstance(value, np.ndarray):
        return value
    kind = type(value).__name__
    if isinstance(value, (list, tuple)):
        raise BadInput(field, f"is a {kind}, must be a numpy array: {accepted}; "
                       f"numpy.array({field}) makes one")
    if not hasattr(value, "__array__") and not hasattr(value, "__array_interface__"):
        raise BadInput(field, f"is a {kind}, must be a numpy array: {accepted}")
    try:
        return np.asarray(value)
    except (TypeError, RuntimeError, ValueError, BufferError) as problem:
        raise BadInput(field, f"is a {kind} that numpy cannot read ({problem}); of a torch tensor "
                       f"give {field}.detach().cpu().numpy()") from None


def _color_shape_remedy(array: NDArray[Any], field: str) -> str:
    if array.ndim == 4 and array.shape[0] == 1:
        return f"; {field}[0] is the first of a batch"
    if array.ndim == 3 and array.shape[0] in (3, 4):
        return f"; with its channels first it becomes numpy.moveaxis({field}, 0, -1)"
    if array.ndim == 2 or (array.ndim == 3 and array.shape[2] == 1):
        return f"; grey becomes numpy.dstack([{field}] * 3)"
    return ""


def _color_type_remedy(array: NDArray[Any], field: str) -> str:
    if sample_type(array) == "u2":
        return f'; 16 bits a channel become {field} / 65535 with transfer="srgb"'
    if array.dtype.kind in _INTEGERS:
        return f"; integers 0..255 become {field}.astype(numpy.uint8)"
    return ""


def color_array(color: Any, field: str) -> NDArray[Any]:
    """uint8 or float [height][width][3 or 4]. Raises BadInput for others."""
    array = as_array(color, field, _COLOR)
    if array.ndim != 3 or array.shape[2] not in (3, 4) or array.size == 0:
        raise BadInput(field, f"has the shape {shape_text(array)}, must be {_COLOR}"
                       + _color_shape_remedy(array, field))
    if sample_type(array) not in ("u1", "f2", "f4", "f8"):
        raise BadInput(field, f"has samples of {array.dtype}, must be {_COLOR}"
                       + _color_type_remedy(array, field))
    return array


def depth_array(depth: Any, field: str) -> NDArray[Any]:
    """float or uint16 [height][width]; one channel, before or behind, is left out. BadInput."""
    array = as_array(depth, field, _DEPTH)
    if array.ndim == 3 and array.shape[2] == 1:
        array = array[..., 0]
    elif array.ndim == 3 and array.shape[0] == 1:
        array = array[0]
    if array.ndim != 2 or array.size == 0:
        remedy = f"; {field}[0, 0] is the first of a batch" if array.ndim == 4 else ""
        raise BadInput(field, f"has the shape {shape_text(array)}, must be {_DEPTH}{remedy}")
    if sample_type(array) not in ("f2", "f4", "f8", "u2"):
        remedy = (f"; millimetres become {field} / 1000, metres {field}.astype(numpy.float32)"
                  if array.dtype.kind in _INTEGERS else "")
        raise BadInput(field, f"has samples of {array.dtype}, must be {_DEPTH}{remedy}")
    return array
