# SPDX-License-Identifier: Apache-2.0
"""numpy arrays as planes of the wire: which arrays are taken, and as what."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from viewloom.arrays import color_array, depth_array, sample_type
from viewloom.coded_color import CodedColor, coded_format
from viewloom.errors import BadInput
from viewloom.messages import message_from
from viewloom.v1 import frame_pb2

DepthFormatLike = Union[frame_pb2.DepthFormat, Mapping[str, Any], None]
_HALF_MAX = 65504.0  # the largest binary16
_U16_MAX = 65535

_DEPTH_ENCODINGS = {"f2": frame_pb2.PLANE_ENCODING_DEPTH_F16,
                    "f4": frame_pb2.PLANE_ENCODING_DEPTH_F32,
                    "f8": frame_pb2.PLANE_ENCODING_DEPTH_F32,
                    "u2": frame_pb2.PLANE_ENCODING_DEPTH_U16}
_TRANSFERS = {"srgb": frame_pb2.COLOR_TRANSFER_SRGB, "linear": frame_pb2.COLOR_TRANSFER_LINEAR}
_PRIMARIES = {"bt709": frame_pb2.COLOR_PRIMARIES_BT709,
              "display_p3": frame_pb2.COLOR_PRIMARIES_DISPLAY_P3,
              "bt2020": frame_pb2.COLOR_PRIMARIES_BT2020}
_ALPHAS = {"opaque": frame_pb2.ALPHA_MODE_OPAQUE, "straight": frame_pb2.ALPHA_MODE_STRAIGHT,
           "premultiplied": frame_pb2.ALPHA_MODE_PREMULTIPLIED}


class WirePlane(NamedTuple):
    """A plane as declared, but for bytes_count and compression, and its samples, packed.

    Of CodedColor, the samples are its bytes.
    """

    declared: frame_pb2.Plane
    samples: NDArray[Any]


class ColorMeaning(NamedTuple):
    """What the numbers of a colour array say; each a word of the tables above."""

    transfer: Optional[str] = None  # None: srgb for uint8, linear for floats
    primaries: str = "bt709"
    alpha: str = "opaque"


def _word(table: Mapping[str, int], word: str, field: str) -> Any:
    if word not in table:
        raise BadInput(field, f"is {word!r}, must be one of {', '.join(table)}")
    return table[word]


def _half_rgba(color: NDArray[Any], field: str) -> NDArray[Any]:
    """RGBA16F. float[height][width][3 or 4], linear light."""
    peak = np.abs(color).max()
    if not peak <= _HALF_MAX:  # NaN compares false
        remedy = ("" if not np.isfinite(peak) or peak > _U16_MAX else
                  f'; if it is 0..65535, give {field} / 65535 with transfer="srgb"')
        raise BadInput(field, f"holds {peak}, must be finite and at most {_HALF_MAX:.0f}: binary16"
                       + remedy)
    half = np.ones((*color.shape[:2], 4), "<f2")
    half[..., :color.shape[2]] = color
    return half


def _coded_plane(color: CodedColor, field: str, meaning: ColorMeaning) -> WirePlane:
    if meaning.alpha != "opaque":
        raise BadInput("alpha", f"is {meaning.alpha}, must be opaque, as {field} is coded")
    coded = coded_format(color, field)
    return WirePlane(frame_pb2.Plane(
        kind=frame_pb2.PLANE_KIND_COLOR, encoding=coded.encoding,
        size={"width": coded.width, "height": coded.height},
        transfer=_word(_TRANSFERS, meaning.transfer or "srgb", "transfer"),
        primaries=_word(_PRIMARIES, meaning.primaries, "primaries")),
        np.frombuffer(color.data, np.uint8))


def color_plane(color: Any, field: str, meaning: ColorMeaning = ColorMeaning()) -> WirePlane:
    """uint8 or float [height][width][3 or 4], top row first, or CodedColor. Raises BadInput."""
    if isinstance(color, CodedColor):
        return _coded_plane(color, field, meaning)
    array = color_array(color, field)
    kind = sample_type(array)
    if kind == "u1":
        encoding = (frame_pb2.PLANE_ENCODING_RGB8 if array.shape[2] == 3
                    else frame_pb2.PLANE_ENCODING_RGBA8)
        samples = np.ascontiguousarray(array)
    else:
        encoding = frame_pb2.PLANE_ENCODING_RGBA16F
        samples = _half_rgba(array, field)
    transfer = meaning.transfer or ("srgb" if kind == "u1" else "linear")
    alpha = _word(_ALPHAS, meaning.alpha, "alpha")
    if meaning.alpha != "opaque" and array.shape[2] == 3:
        raise BadInput("alpha", f"is {meaning.alpha}, must be opaque, as {field} has three "
                       "channels")
    return WirePlane(frame_pb2.Plane(
        kind=frame_pb2.PLANE_KIND_COLOR, encoding=encoding,
        size={"width": array.shape[1], "height": array.shape[0]},
        transfer=_word(_TRANSFERS, transfer, "transfer"),
        primaries=_word(_PRIMARIES, meaning.primaries, "primaries"), alpha=alpha), samples)


def depth_format(given: DepthFormatLike) -> Optional[frame_pb2.DepthFormat]:
    """A DepthFormat, or a mapping of its fields; None stays None."""
    if given is None:
        return None
    return message_from(given, frame_pb2.DepthFormat(), "depth_format",
                        "a mapping or a DepthFormat")


def depth_plane(depth: Any, field: str,
                given: Optional[frame_pb2.DepthFormat] = None) -> WirePlane:
    """float or uint16 [height][width], top row first; without a format: metres along the view axis.

    float64 is sent as float32. uint16 has no natural unit and needs a format.
    """
    array = depth_array(depth, field)
    kind = sample_type(array)
    if kind == "u2" and given is None:
        raise BadInput("depth_format", f"is needed, as {field} is uint16: of millimetres it is "
                       "{'meaning': 'DEPTH_MEANING_PLANAR', 'scale': 0.001, 'invalid_value': 0}")
    with np.errstate(over="ignore"):  # what is too far for float32 is infinitely far
        wire_type = "<f4" if kind == "f8" else f"<{kind}"
        samples = np.ascontiguousarray(array.astype(wire_type, copy=False))
    return WirePlane(frame_pb2.Plane(
        kind=frame_pb2.PLANE_KIND_DEPTH, encoding=_DEPTH_ENCODINGS[kind],
        size={"width": array.shape[1], "height": array.shape[0]},
        depth=given or frame_pb2.DepthFormat(meaning=frame_pb2.DEPTH_MEANING_PLANAR)), samples)
