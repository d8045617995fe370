# SPDX-License-Identifier: Apache-2.0
"""Warns of arrays that are taken as they are, and probably mean something else."""

from __future__ import annotations

import warnings
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from viewloom.arrays import color_array, depth_array
from viewloom.coded_color import CodedColor
from viewloom.errors import UnlikelyInput
from viewloom.planes import depth_format
from viewloom.source import Source
from viewloom.v1 import frame_pb2

_METRIC = (frame_pb2.DEPTH_MEANING_PLANAR, frame_pb2.DEPTH_MEANING_RAY_DISTANCE)
_SURFACE_SHARE_MIN = 1e-4  # of a picture's px; fewer show nothing
_SPARSE_PX = 1 << 16
_FAR_M = 100.0      # median of surfaces: rooms in millimetres are beyond, scenes rarely
_BRIGHT = 2.0       # median of linear light, 1 = white: pictures in 0..255 are beyond
_STACK_LEVEL = 5    # the caller of send()


def _layers(value: Any, read: Callable[[Any, str], NDArray[Any]]) -> list[NDArray[Any]]:
    return [read(layer, "") for layer in (value if isinstance(value, (list, tuple)) else [value])]


def _sparse(array: NDArray[Any]) -> NDArray[Any]:
    """Every so many rows and columns of it, and no more than is soon looked at."""
    step = max(1, int((array.shape[0] * array.shape[1] / _SPARSE_PX) ** 0.5))
    return array[step // 2::step, step // 2::step]


def _is_surface(depth: NDArray[Any], form: Optional[frame_pb2.DepthFormat]) -> NDArray[np.bool_]:
    """Which samples show a surface that is not infinitely far."""
    samples = depth.astype(np.float64)
    form = form or frame_pb2.DepthFormat(meaning=frame_pb2.DEPTH_MEANING_PLANAR)
    if form.HasField("invalid_value"):
        samples[samples == form.invalid_value] = np.nan
    if form.meaning != frame_pb2.DEPTH_MEANING_WINDOW:
        samples = samples * (form.scale or 1.0) + form.offset
        samples[samples <= 0] = np.nan
    surfaces: NDArray[np.bool_] = np.isfinite(samples)
    return surfaces


def _nothing_seen(depths: list[NDArray[Any]],
                  form: Optional[frame_pb2.DepthFormat]) -> Optional[str]:
    if any(_is_surface(_sparse(depth), form).mean() > _SURFACE_SHARE_MIN for depth in depths):
        return None
    surfaces = sum(int(_is_surface(depth, form).sum()) for depth in depths)
    count = sum(depth.size for depth in depths)
    if surfaces > _SURFACE_SHARE_MIN * count:
        return None
    samples = np.concatenate([depth.astype(np.float64).ravel() for depth in depths])
    kinds = {"NaN": np.isnan(samples), "0": samples == 0, "negative": samples < 0,
             "infinite": np.isposinf(samples)}
    shares = {name: float(found.mean()) for name, found in kinds.items() if found.any()}
    held = ", ".join(f"{share:.0%} {name}" for name, share in shares.items())
    if shares.get("negative", 0) > 0.5:
        remedy = ("if it counts against the view axis, as OpenGL's Z does, give -depth")
    elif form is not None and form.HasField("invalid_value"):
        remedy = ("check depth_format: its invalid_value, scale and offset decide which samples "
                  "are surfaces")
    else:
        remedy = ("give metres along the view axis, greater than 0; without a measurement use NaN, "
                  "and +inf for the sky alone")
    return f"depth shows no surface ({held or 'nothing nearer than infinity'}): {remedy}"


def _far_away(depth: NDArray[Any]) -> Optional[str]:
    """Of metres that nobody stated to be metres."""
    values = depth[_is_surface(depth, None)]
    median = float(np.median(values)) if values.size else 0.0
    if median <= _FAR_M:
        return None
    return (f"half of the surfaces are beyond {median:.4g} m: if depth is in millimetres, give "
            "depth / 1000, and depth / 100 if it is in centimetres; if it is in metres, say so: "
            'depth_format={"meaning": "DEPTH_MEANING_PLANAR"}')


def _color_range(color: NDArray[Any], transfer: Optional[str]) -> Optional[str]:
    peak, median = float(color.max()), float(np.median(color[..., :3].max(axis=-1)))
    if color.dtype.kind == "u":
        if peak != 1:
            return None
        return ("color holds 0 and 1 alone, of 255: if it was 0..1 before it became integers, give "
                "the floats, or multiply by 255 first")
    white = 1.0 if transfer == "srgb" else _BRIGHT
    is_counted = peak > 1 and bool((color == np.rint(color)).all())
    if not (is_counted and peak > _BRIGHT) and not median > white:
        return None
    full = 255 if peak < 300 else 65535
    return (f"color reaches {peak:.4g} (median {median:.4g}), and of floats 1 is white: if it is "
            f'0..{full}, give color / {full} with transfer="srgb"'
            + (", or color.astype(np.uint8)" if full == 255 else ""))


def _turned(color: NDArray[Any], depth: NDArray[Any]) -> Optional[str]:
    (height, width), (rows, columns) = color.shape[:2], depth.shape
    if height == width or (height, width) != (columns, rows):
        return None
    return (f"color is {width}x{height} px and depth {columns}x{rows}: if one of them is turned, "
            "give depth.T, or color.transpose(1, 0, 2)")


class FrameWarnings:
    """Warns of each thing once a stream; looks at frames until one had nothing to warn of."""

    def __init__(self) -> None:
        self._warned: set[str] = set()
        self._is_trusted = False

    def frame(self, sources: Union[Source, Sequence[Source]]) -> None:
        """To be called with every frame that was accepted."""
        for source in [sources] if isinstance(sources, Source) else sources:
            self._source(source)

    def _source(self, source: Source) -> None:
        depths = _layers(source.depth, depth_array)
        form = depth_format(source.depth_format)
        if "surface" not in self._warned:
            self._warn("surface", _nothing_seen(depths, form))
        if self._is_trusted:
            return
        front = source.color[0] if isinstance(source.color, (list, tuple)) else source.color
        if isinstance(front, CodedColor):  # its samples are not at hand
            return
        color = color_array(front, "")
        found = {"range": _color_range(_sparse(color), source.transfer),
                 "turned": _turned(color, depths[0]),
                 "unit": None if form is not None else _far_away(_sparse(depths[0]))}
        for name, text in found.items():
            self._warn(name, text)
        self._is_trusted = not any(found.values())

    def _warn(self, name: str, text: Optional[str]) -> None:
        if text is None or name in self._warned:
            return
        self._warned.add(name)
        warnings.warn(text, UnlikelyInput, stacklevel=_STACK_LEVEL)
