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
from viewloom.clock import (ClockOffset, ServerClock, connection_broke_meanwhile,
                            presented_request, probe_request)
from viewloom.connection import Connection
from viewloom.display import (DisplayLike, EncodingLike, EyeLike, Opening, change_request,
                              eyes_request)
from viewloom.errors import ViewloomError, error_from_rpc
from viewloom.retry import HEARTBEAT_S, Backoff, SilenceWatch, is_passing
from viewloom.v1.display_service_pb2 import StreamAtlasesRequest
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub


class Watcher(Iterator[Atlas]):
    """Atlases as they come, the newest first: an iterator. See Server.watch.

    A thread of its own reads; a newer atlas takes the place of one that was not taken, and is
    counted in Atlas.skipped. When the connection breaks, it calls again.
    Thread-safety: all methods may be called from any thread.
    """

    def __init__(self, connection: Connection, opening: StreamAtlasesRequest,
                 reconnect: bool) -> None:
        self._connection = connection
        self._opening = Opening(opening)
        self._reconnects = reconnect
        self._requests: queue.SimpleQueue[Optional[StreamAtlasesRequest]] = queue.SimpleQueue()
        self._changed = threading.Condition()
        self._inbox = AtlasInbox(self._opening.stream)
        self._clock = ServerClock()
        self._is_heard = False  # the server has answered the call that is under way
        self._call_count = 0
        self._call: Any = None
        self._closed = threading.Event()
        self._open_call()
        self._reader = threading.Thread(target=self._run, name="viewloom-watcher", daemon=True)
        self._reader.start()

    def _open_call(self) -> None:
        """Under the lock, where there are other threads."""
        self._requests = queue.SimpleQueue()
        for request in self._opening.requests():
            self._requests.put(request)
        self._silence = SilenceWatch()
        self._inbox.begin_call()
        self._call_count += 1
        self._is_heard = False
        self._call = DisplayServiceStub(self._connection.channel).StreamAtlases(
            self._outgoing(self._requests, self._silence), wait_for_ready=self._call_count > 1,
            metadata=self._connection.metadata)

    def _outgoing(self, requests: queue.SimpleQueue[Optional[StreamAtlasesRequest]],
                  silence: SilenceWatch) -> Iterator[StreamAtlasesRequest]:
        while True:
            try:
                request = requests.get(timeout=HEARTBEAT_S)
            except queue.Empty:
                if silence.tick():
                    self._call.cancel()
                continue
            if request is None:
                return
            yield request

    def _run(self) -> None:
        backoff = Backoff()
        was_heard = False
        while True:
            error = self._read_call()
            was_heard |= self._is_heard
            if self._closed.is_set() or error is None:
                error = None
                break
            if not (self._reconnects and was_heard and is_passing(error)):
                break
            if self._is_heard:
                backoff.reset()
            self._closed.wait(backoff.delay_s(error))
            with self._changed:
                if self._closed.is_set():
                    error = None
                    break
                self._open_call()
        with self._changed:
            self._inbox.end(error)
            self._changed.notify_all()

    def _read_call(self) -> Optional[ViewloomError]:
        """Takes what comes; what the call ended with, None = in order."""
        try:
            for response in self._call:
                self._silence.hears(response.HasField("heartbeat"))
                with self._changed:
                    self._is_heard = True
                    if response.HasField("clock_reply"):
                        self._clock.add(response.clock_reply)
                    else:
                        self._inbox.add(response)
                    self._changed.notify_all()
        except grpc.RpcError as problem:
            return error_from_rpc(problem, self._connection.address)
        except ViewloomError as problem:
            self._call.cancel()
            return problem
        finally:
            self._requests.put(None)  # lets go of the thread that waits for changes
        return None

    def _send(self, request: StreamAtlasesRequest) -> None:
        with self._changed:
            self._opening.note(request)
            self._requests.put(request)

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
        self._send(change_request(display, encoding))

    def send_eye_poses(self, left: EyeLike, right: EyeLike, *, time_ns: int = 0,
                       predicted_display_time_ns: int = 0) -> None:
        """Where the eyes before a tracked stereo display are now.

        left, right: x, y, z relative to the display: metres to the right, up and backwards; or a
                     Camera, with what the eye sees.
        time_ns, predicted_display_time_ns: of any clock; in the header of atlases seen by them.
        Poses overtaken by newer ones are dropped; one that the server refuses ends the call.
        """
        self._send(eyes_request(left, right, time_ns, predicted_display_time_ns))

    def report_presented(self, atlas: Atlas, presented_time_ns: int) -> None:
        """When it was shown, by the clock of the eye poses: what motion to picture takes."""
        self._send(presented_request(atlas.header.sequence, presented_time_ns))

    def measure_clock(self, probes: int = 8, timeout_s: Optional[float] = None) -> ClockOffset:
        """How far the server's clock, of eye_poses_latched_ns, is ahead of time.monotonic_ns().

        probes: so often it is asked, one after the other; the quickest answer counts.
        Raises ViewloomError: what the call ended with, or DEADLINE_EXCEEDED after timeout_s for
        one of them.
        """
        with self._changed:
            self._clock = ServerClock()
            call_count = self._call_count
            for count in range(1, probes + 1):
                self._requests.put(probe_request())
                if not self._changed.wait_for(
                        lambda: self._clock.count >= count or self._inbox.is_ended
                        or self._call_count != call_count, timeout_s):
                    raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                        f"no answer came within {timeout_s} s")
                self._inbox.raise_if_ended()
                if self._call_count != call_count:
                    raise connection_broke_meanwhile()
            return self._clock.offset()

    def close(self) -> None:
        """Breaks off; who waits in receive() gets None."""
        with self._changed:
            self._closed.set()
            self._call.cancel()
        self._reader.join()

    def __repr__(self) -> str:
        return (f"<viewloom.Watcher of {self._opening.stream!r} at {self._connection.address}, "
                f"{'ended' if self._inbox.is_ended else 'open'}>")

    def __enter__(self) -> Watcher:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()
