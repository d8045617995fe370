# SPDX-License-Identifier: Apache-2.0
"""Joins the messages of a call into atlases, and keeps the newest whole one."""

from __future__ import annotations

from typing import Optional

import grpc

from viewloom.atlas import Atlas, Band
from viewloom.errors import ViewloomError, data_loss
from viewloom.stack import VideoDecoder
from viewloom.tiles import check_layout
from viewloom.v1 import display_service_pb2
from viewloom.v1.atlas_pb2 import PREDICTION_ACROSS_ATLASES, AtlasLayout
from viewloom.v1.display_service_pb2 import AtlasEnd, AtlasHeader, StreamAtlasesResponse

# More than any atlas: 16384x16384 px of colour, depth and mask, not packed.
_BYTES_MAX = 8 * 16384 * 16384


def _take_outcome(header: AtlasHeader, end: AtlasEnd) -> None:
    """Older servers, and recordings of them, say it before the bands."""
    for name in ("times", "coverage", "reflections"):
        if header.HasField(name) and not end.HasField(name):
            getattr(end, name).CopyFrom(getattr(header, name))
        header.ClearField(name)


class AtlasInbox:
    """One slot: a newer atlas takes the place of one that was not taken. Thread-safety: none."""

    def __init__(self, stream: str = "") -> None:
        self._stream = stream
        self._layout: Optional[AtlasLayout] = None
        self._header: Optional[AtlasHeader] = None  # of the atlas that is open
        self._bands: list[Band] = []
        self._band_is_open = False
        self._bytes = 0
        self._chain: Optional[VideoDecoder] = None  # of the layout, if its video is chained
        self._newest: Optional[Atlas] = None
        self._skipped = 0  # since the newest one that was taken
        self.is_ended = False
        self._error: Optional[ViewloomError] = None

    def begin_call(self) -> None:
        """What comes next belongs to another call: what was begun is discarded."""
        self._layout = self._header = self._chain = None

    def add(self, response: StreamAtlasesResponse) -> None:
        """Takes a message in. Raises DATA_LOSS when it does not follow those before."""
        kind = response.WhichOneof("message")
        if kind == "layout":
            check_layout(response.layout)
            self._layout, self._header = response.layout, None
            is_chained = response.layout.encoding.prediction == PREDICTION_ACROSS_ATLASES
            self._chain = (self._chain or VideoDecoder()) if is_chained else None
        elif kind == "header":  # what was begun, and has not ended, is discarded
            self._header, self._bands, self._band_is_open = response.header, [], False
            self._bytes = 0
        elif kind == "band":
            self._add_band(response.band)
        elif kind == "end":
            self._finish(response.end)
        elif kind == "abandoned":  # what the server began will never be whole
            self._header = None
        elif kind == "skipped":
            self._skipped += response.skipped.count

    def _add_band(self, piece: display_service_pb2.Band) -> None:
        if self._header is None or piece.sequence != self._header.sequence:
            raise data_loss(f"a band of atlas {piece.sequence} came outside it")
        if not self._band_is_open:
            if piece.row_count == 0 or len(self._bands) == self._header.band_count:
                raise data_loss(f"atlas {piece.sequence} has a band without rows, or more bands "
                                f"than the {self._header.band_count} that its header says")
            self._bands.append(Band(piece.image_index, piece.plane, piece.first_row,
                                    piece.row_count, piece.encoding, bytearray()))
        band = self._bands[-1]
        if (piece.offset_bytes, piece.first_row, piece.plane, piece.image_index) != (
                len(band.data), band.first_row, band.plane, band.image_index):
            raise data_loss(f"a piece of atlas {piece.sequence}, row {piece.first_row}, came out "
                            "of order")
        self._bytes += len(piece.data)
        if self._bytes > _BYTES_MAX:
            raise data_loss(f"atlas {piece.sequence} has more than {_BYTES_MAX} bytes")
        band.data += piece.data
        self._band_is_open = not piece.last_piece

    def _finish(self, end: AtlasEnd) -> None:
        sequence = end.sequence
        if (self._layout is None or self._header is None or self._header.sequence != sequence
                or self._band_is_open or len(self._bands) != self._header.band_count):
            raise data_loss(f"atlas {sequence} ended before it was whole")
        self._skipped += self._newest is not None
        _take_outcome(self._header, end)
        atlas = Atlas(self._layout, self._header, self._bands, end, stream=self._stream)
        if self._chain is not None:  # the next one refers to it, also if nobody takes it
            atlas.pictures = list(self._chain.decode(atlas.access_units(), self._header,
                                                     self._layout))
        self._newest = atlas
        self._header = None

    def end(self, error: Optional[ViewloomError]) -> None:
        """The call is over: with an error, or, with None, in order."""
        self.is_ended, self._error = True, error

    def is_ready(self) -> bool:
        """Whether take() has something to give or to say."""
        return self._newest is not None or self.is_ended

    def raise_if_ended(self) -> None:
        """What the call ended with; CANCELLED where it ended in order."""
        if self.is_ended:
            raise self._error or ViewloomError(grpc.StatusCode.CANCELLED, "", "the call is over")

    def take(self) -> Optional[Atlas]:
        """The newest atlas; after the last one None, or what the call ended with is raised."""
        atlas, self._newest = self._newest, None
        if atlas is not None:
            atlas.skipped, self._skipped = self._skipped, 0
        elif self._error is not None:
            raise self._error
        return atlas
