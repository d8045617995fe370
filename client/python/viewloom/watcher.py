# SPDX-License-Identifier: Apache-2.0
"""Watches one stream on one display, for callers that block."""

from __future__ import annotations

import queue
import threading
from types import TracebackType
from typing import Any, Iterator, Optional

import grpc

from viewloom.atlas import Atlas
from viewloom.atlas_inbox import AtlasInbox
from viewloom.clock import ClockOffset, ServerClock, presented_request, probe_request
from viewloom.display import (DisplayLike, EncodingLike, EyeLike, change_request,
                              eyes_request)
from viewloom.errors import ViewloomError, error_from_rpc
from viewloom.v1.display_service_pb2 import StreamAtlasesRequest
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub


class Watcher(Iterator[Atlas]):
    """Atlases as they come, the newest first: an iterator. See Server.watch.

    A thread of its own reads; a newer atlas takes the place of one that was not taken, and is
    counted in Atlas.skipped.
    Thread-safety: all methods may be called from any thread.
    """

    def __init__(self, channel: Any, opening: StreamAtlasesRequest) -> None:
        self._requests: queue.SimpleQueue[Optional[StreamAtlasesRequest]] = queue.SimpleQueue()
        self._requests.put(opening)
        self._changed = threading.Condition()
        self._inbox = AtlasInbox()
        self._clock = ServerClock()
        self._is_closed = False
        self._call = DisplayServiceStub(channel).StreamAtlases(iter(self._requests.get, None))
        self._reader = threading.Thread(target=self._read, name="viewloom-watcher", daemon=True)
        self._reader.start()

    def _read(self) -> None:
        error: Optional[ViewloomError] = None
        try:
            for response in self._call:
                with self._changed:
                    if response.HasField("clock_reply"):
                        self._clock.add(response.clock_reply)
                    else:
                        self._inbox.add(response)
                    self._changed.notify_all()
        except grpc.RpcError as problem:
            error = None if self._is_closed else error_from_rpc(problem)
        except ViewloomError as problem:
            error = problem
            self._call.cancel()
        finally:
            with self._changed:
                self._inbox.end(error)
                self._changed.notify_all()
            self._requests.put(None)  # lets go of the thread that waits for changes

    def receive(self, timeout_s: Optional[float] = None) -> Optional[Atlas]:
        """The newest atlas that was not given yet; waits for one. None = it is over.

        Raises ViewloomError: what the call ended with, or DEADLINE_EXCEEDED after timeout_s.
        """
        with self._changed:
            if not self._changed.wait_for(self._inbox.is_ready, timeout_s):
                raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                    f"no atlas came within {timeout_s} s")
            return self._inbox.take()

    def __next__(self) -> Atlas:
        atlas = self.receive()
        if atlas is None:
            raise StopIteration
        return atlas

    def change(self, display: Optional[DisplayLike] = None, encoding: EncodingLike = None) -> None:
        """Another display, another encoding, or both, from now on. What is None stays.

        An atlas of the display before may still come.
        """
        self._requests.put(change_request(display, encoding))

    def send_eye_poses(self, left: EyeLike, right: EyeLike, *, time_ns: int = 0,
                       predicted_display_time_ns: int = 0) -> None:
        """Where the eyes before a tracked stereo display are now.

        left, right: x, y, z relative to the display: metres to the right, up and backwards; or a
                     Camera, with what the eye sees.
        time_ns, predicted_display_time_ns: of any clock; in the header of atlases seen by them.
        Poses overtaken by newer ones are dropped; one that the server refuses ends the call.
        """
        self._requests.put(eyes_request(left, right, time_ns, predicted_display_time_ns))

    def report_presented(self, atlas: Atlas, presented_time_ns: int) -> None:
        """When it was shown, by the clock of the eye poses: what motion to picture takes."""
        self._requests.put(presented_request(atlas.header.sequence, presented_time_ns))

    def measure_clock(self, probes: int = 8, timeout_s: Optional[float] = None) -> ClockOffset:
        """How far the server's clock, of eye_poses_latched_ns, is ahead of time.monotonic_ns().

        probes: so often it is asked, one after the other; the quickest answer counts.
        Raises ViewloomError: what the call ended with, or DEADLINE_EXCEEDED after timeout_s for
        one of them.
        """
        with self._changed:
            self._clock = ServerClock()
            for count in range(1, probes + 1):
                self._requests.put(probe_request())
                if not self._changed.wait_for(
                        lambda: self._clock.count >= count or self._inbox.is_ended, timeout_s):
                    raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                        f"no answer came within {timeout_s} s")
                self._inbox.raise_if_ended()
            return self._clock.offset()

    def close(self) -> None:
        """Breaks off; who waits in receive() gets None."""
        self._is_closed = True
        self._call.cancel()
        self._reader.join()

    def __enter__(self) -> Watcher:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()
