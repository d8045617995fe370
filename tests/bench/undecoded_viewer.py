# SPDX-License-Identifier: Apache-2.0
"""Viewers that keep a digest of each atlas, and decode none: many of them take little time. Needs
the Python package, which a build has in client/python."""

import dataclasses
import hashlib
import pathlib
import sys
import threading
import time

import grpc

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "atlases"))
from served_build import Watching  # noqa: E402
from viewloom.connection import CHANNEL_OPTIONS  # noqa: E402
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub  # noqa: E402

PATIENCE_S = 120


def encodings(qp):
    """Fields of AtlasEncoding by the names in the tables. qp: quantisation of H.264."""
    video = {"color": "BAND_ENCODING_H264", "video_qp": qp}
    return {"JPEG": {"color": "BAND_ENCODING_JPEG"},
            "H.264": {**video, "prediction": "PREDICTION_WITHIN_ATLAS"},
            "H.264, chained": {**video, "prediction": "PREDICTION_ACROSS_ATLASES"}}


@dataclasses.dataclass
class SeenAtlas:
    """A whole atlas, without its bytes."""
    rung: int
    sequence: int
    refers: bool  # to the atlas before
    picture_count: int  # of video
    size_bytes: int
    digest: str
    time_s: float  # monotonic, of its end


class UndecodedViewer:
    """Watches one display, on a connection of its own, until stop()."""

    def __init__(self, address, stream, display, encoding):
        self._atlases = []
        self._layout = self._header = None
        self._changed = threading.Condition()
        self._channel = grpc.insecure_channel(address, options=CHANNEL_OPTIONS)
        self._watching = Watching(
            DisplayServiceStub(self._channel),
            {"stream": stream, "display": display, "encoding": encoding, "wait_for_stream": True},
            self._note)

    def _note(self, message):
        kind = message.WhichOneof("message")
        if kind == "layout":
            self._layout = message.layout
        elif kind == "header":
            self._header = message.header
            self._digest, self._size_bytes = hashlib.sha256(), 0
        elif kind == "band":
            band = message.band
            if band.offset_bytes == 0:  # pieces may be cut otherwise for another viewer
                self._digest.update(b"%d %d %d " % (band.image_index, band.plane, band.first_row))
            self._digest.update(band.data)
            self._size_bytes += len(band.data)
        elif kind == "end":
            self._add()

    def _add(self):
        atlas = SeenAtlas(
            rung=self._layout.video_rung, sequence=self._header.sequence,
            refers=self._header.reference_sequence != 0,
            picture_count=self._layout.video.picture_count, size_bytes=self._size_bytes,
            digest=self._digest.hexdigest(), time_s=time.monotonic())
        with self._changed:
            self._atlases.append(atlas)
            self._changed.notify()

    def atlases(self):
        with self._changed:
            return list(self._atlases)

    def wait_for(self, holds):
        """Until that holds of the atlases so far."""
        with self._changed:
            if not self._changed.wait_for(lambda: holds(self._atlases), timeout=PATIENCE_S):
                raise TimeoutError(f"{len(self._atlases)} atlases came in {PATIENCE_S} s")

    def wait_for_quiet(self, quiet_s):
        """Until no atlas has come for so long."""
        deadline = time.monotonic() + PATIENCE_S
        while (now := time.monotonic()) - self.atlases()[-1].time_s < quiet_s:
            if now > deadline:
                raise TimeoutError(f"atlases still come after {PATIENCE_S} s")
            time.sleep(0.02)

    def stop(self):
        self._watching.stop()
        self._channel.close()
