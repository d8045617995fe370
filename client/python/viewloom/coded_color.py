# SPDX-License-Identifier: Apache-2.0
"""Colour that a codec of the caller has packed: it travels as it is."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

from viewloom.errors import BadInput
from viewloom.v1 import frame_pb2

_ENCODINGS = {"h264": frame_pb2.PLANE_ENCODING_H264, "jpeg": frame_pb2.PLANE_ENCODING_JPEG}


@dataclasses.dataclass(frozen=True)
class CodedColor:
    """A colour plane as bytes, in place of an array in Source.color.

    data:     a baseline JPEG; or H.264 that needs no other frame: IDR pictures with full range and
              the weights of BT.601, as proto PLANE_ENCODING_H264 says.
    size_px:  (width, height) of the picture.
    encoding: "h264" or "jpeg".
    """

    data: bytes
    size_px: tuple[int, int]
    encoding: str = "h264"

    def __repr__(self) -> str:
        return (f"viewloom.CodedColor({len(self.data)} bytes, {self.size_px!r}, "
                f"{self.encoding!r})")


class CodedFormat(NamedTuple):
    """What a plane of these bytes declares."""

    encoding: Any  # a PlaneEncoding
    width: int
    height: int


def coded_format(color: CodedColor, field: str) -> CodedFormat:
    """Raises BadInput for other values than CodedColor names."""
    if color.encoding not in _ENCODINGS:
        raise BadInput(field, f"has the encoding {color.encoding!r}, must be one of "
                       f"{', '.join(_ENCODINGS)}")
    if not isinstance(color.data, (bytes, bytearray, memoryview)) or len(color.data) == 0:
        raise BadInput(field, "has no bytes of a picture: give bytes, bytearray or a memoryview")
    size_px = color.size_px
    is_size = (isinstance(size_px, (tuple, list)) and len(size_px) == 2
               and all(isinstance(side, int) and side > 0 for side in size_px))
    if not is_size:
        raise BadInput(field, f"has the size {size_px!r}, must be (width, height) in pixels")
    return CodedFormat(_ENCODINGS[color.encoding], *size_px)
