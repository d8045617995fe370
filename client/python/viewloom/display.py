# SPDX-License-Identifier: Apache-2.0
"""Displays and encodings as callers write them: preset names, mappings and messages."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from viewloom.errors import BadInput
from viewloom.messages import message_from
from viewloom.v1 import atlas_pb2, display_pb2, geometry_pb2
from viewloom.v1.display_service_pb2 import (ChangeDisplay, EyePoses, OpenDisplay,
                                             StreamAtlasesRequest)

DisplayLike = Union[display_pb2.Display, Mapping[str, Any], str]
EyeLike = Union[geometry_pb2.Camera, Sequence[float]]
EncodingLike = Union[atlas_pb2.AtlasEncoding, Mapping[str, Any], None]

_CHROMAS = {420: atlas_pb2.CHROMA_SUBSAMPLING_420, 444: atlas_pb2.CHROMA_SUBSAMPLING_444}


def display_from(display: DisplayLike) -> display_pb2.Display:
    """A Display; a mapping of its fields, {"quilt": {"columns": 8, ...}}; or a preset's name."""
    if isinstance(display, str):
        return display_pb2.Display(preset=display)
    return message_from(display, display_pb2.Display(), "display",
                         "a preset's name, a mapping or a Display")


def encoding(*, lossless: bool = False, depth: bool = False, mask: bool = False,
             jpeg_quality: int = 0, chroma: Optional[int] = None, h264: bool = False,
             video_qp: int = 0, chained: bool = False) -> atlas_pb2.AtlasEncoding:
    """How atlases are to come.

    lossless:      colour as it was traced, instead of as a JPEG.
    h264:          colour as a video through the views, at a quarter of the bytes of a JPEG.
    video_qp:      of H.264: quantisation, 20 (best) to 51; 0 = the error of jpeg_quality.
    chained:       of H.264: atlases refer to the one before. Takes fewer bytes, and decodes every
                   atlas, also those that nobody looks at.
    depth, mask:   also the planes Atlas.inv_z and Atlas.mask, which are always lossless.
    jpeg_quality:  1..100; 0 = the server's default.
    chroma:        of a JPEG, 420 (half resolution) or 444; None = the server's default.
    """
    if chroma is not None and chroma not in _CHROMAS:
        raise BadInput("chroma", f"is {chroma}, must be 420 or 444")
    if lossless and h264:
        raise BadInput("h264", "is given with lossless; accepted is one of the two")
    if chained and not h264:
        raise BadInput("chained", "is given without h264; accepted is both")
    color = atlas_pb2.BAND_ENCODING_UNSPECIFIED
    if lossless or h264:
        color = atlas_pb2.BAND_ENCODING_ZSTD if lossless else atlas_pb2.BAND_ENCODING_H264
    return atlas_pb2.AtlasEncoding(
        color=color, jpeg_quality=jpeg_quality, with_depth=depth, with_mask=mask,
        video_qp=video_qp, prediction=(
            atlas_pb2.PREDICTION_ACROSS_ATLASES if chained else atlas_pb2.PREDICTION_UNSPECIFIED),
        chroma=atlas_pb2.CHROMA_SUBSAMPLING_UNSPECIFIED if chroma is None else _CHROMAS[chroma])


def _encoding_from(given: EncodingLike) -> Optional[atlas_pb2.AtlasEncoding]:
    if given is None:
        return None
    return message_from(given, atlas_pb2.AtlasEncoding(), "encoding",
                         "of viewloom.encoding(), a mapping or an AtlasEncoding")


def open_request(stream: str, display: DisplayLike, given: EncodingLike, *, count: int,
                 wait_for_stream: bool) -> StreamAtlasesRequest:
    """Asks for so many atlases, 0 = until the call ends."""
    return StreamAtlasesRequest(open=OpenDisplay(
        stream=stream, display=display_from(display), encoding=_encoding_from(given), count=count,
        wait_for_stream=wait_for_stream, wants_heartbeats=count == 0))


def change_request(display: Optional[DisplayLike], given: EncodingLike) -> StreamAtlasesRequest:
    """Replaces what is not None."""
    return StreamAtlasesRequest(change=ChangeDisplay(
        display=None if display is None else display_from(display),
        encoding=_encoding_from(given)))


def _eye_from(eye: EyeLike, field: str) -> geometry_pb2.Camera:
    if isinstance(eye, geometry_pb2.Camera):
        return eye
    place = np.asarray(eye)
    if place.shape != (3,) or place.dtype.kind not in "iuf":
        raise BadInput(field, f"is {eye!r}, must be x, y, z in metres or a Camera")
    x, y, z = (float(axis_m) for axis_m in place)
    return geometry_pb2.Camera(pose={"position": {"x": x, "y": y, "z": z}})


def eyes_request(left: EyeLike, right: EyeLike, time_ns: int,
                 predicted_display_time_ns: int) -> StreamAtlasesRequest:
    """Where the eyes before a tracked display are."""
    return StreamAtlasesRequest(eye_poses=EyePoses(
        time_ns=time_ns, predicted_display_time_ns=predicted_display_time_ns,
        eyes=[_eye_from(left, "left"), _eye_from(right, "right")]))


class Opening:
    """What a call is opened with, and opened with again: it follows what was asked for since.

    Thread-safety: none.
    """

    def __init__(self, opening: StreamAtlasesRequest) -> None:
        self._opening = opening
        self._eyes: Optional[StreamAtlasesRequest] = None

    @property
    def stream(self) -> str:
        """Name of the stream that is watched."""
        return self._opening.open.stream

    def requests(self) -> list[StreamAtlasesRequest]:
        """For a call. A later one waits for the stream: its publisher may come back later."""
        opening = StreamAtlasesRequest()
        opening.CopyFrom(self._opening)
        self._opening.open.wait_for_stream = True
        return [opening] if self._eyes is None else [opening, self._eyes]

    def note(self, request: StreamAtlasesRequest) -> None:
        """Takes in what is asked for within the call."""
        if request.HasField("eye_poses"):
            self._eyes = request
        if not request.HasField("change"):
            return
        change = request.change
        if change.HasField("display"):
            self._opening.open.display.CopyFrom(change.display)
            self._eyes = None  # they were before the display that is left
        if change.HasField("encoding"):
            self._opening.open.encoding.CopyFrom(change.encoding)
