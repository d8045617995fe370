# SPDX-License-Identifier: Apache-2.0
"""Publishes one stream, for callers that block."""

from __future__ import annotations

import queue
import threading
import time
from concurrent.futures import Future
from types import TracebackType
from typing import Any, Iterator, Optional

import grpc

from viewloom.errors import ViewloomError, error_from_rpc
from viewloom.frame_messages import Sources, frame_messages, settings_message
from viewloom.report_ledger import ReportLedger
from viewloom.v1.ingest_service_pb2 import (FrameReport, PublishAccepted, PublishFramesRequest,
                                            Wanted)
from viewloom.v1.ingest_service_pb2_grpc import IngestServiceStub

CLOSE_TIMEOUT_S = 30.0


def not_reported(timeout_s: float) -> ViewloomError:
    """Why a publisher was broken off instead of closed."""
    return ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                         f"frames were not reported within {timeout_s} s of closing")


def _make_promise() -> Future[FrameReport]:
    promise: Future[FrameReport] = Future()
    promise.set_running_or_notify_cancel()  # what was sent cannot be taken back
    return promise


class Publisher:
    """A stream, from when the server has accepted it until close(). See Server.publish.

    Thread-safety: all methods may be called from any thread; frames of several threads go one
    after the other.
    """

    def __init__(self, channel: Any, stream: str, session_id: str, zstd_level: int,
                 in_flight_max: int) -> None:
        self._zstd_level = zstd_level
        self._frames: queue.SimpleQueue[Optional[list[PublishFramesRequest]]] = queue.SimpleQueue()
        self._send_lock = threading.Lock()
        self._changed = threading.Condition()
        self._ledger = ReportLedger(_make_promise, in_flight_max)
        self._error: Optional[ViewloomError] = None
        self._is_broken_off = False
        self._call = IngestServiceStub(channel).PublishFrames(self._requests(stream, session_id))
        self._reader = threading.Thread(target=self._read, name="viewloom-publisher", daemon=True)
        self._reader.start()
        with self._changed:
            self._changed.wait_for(lambda: self._ledger.accepted or self._ledger.ended)
        if self._error is not None:
            raise self._error

    def _requests(self, stream: str, session_id: str) -> Iterator[PublishFramesRequest]:
        yield settings_message(stream, session_id)
        for messages in iter(self._frames.get, None):
            yield from messages

    def _read(self) -> None:
        try:
            for response in self._call:
                with self._changed:
                    self._ledger.take(response)
                    self._changed.notify_all()
        except grpc.RpcError as problem:
            self._error = None if self._is_broken_off else error_from_rpc(problem)
        finally:
            with self._changed:
                self._ledger.end(self._error)
                self._changed.notify_all()
            self._frames.put(None)  # lets go of the thread that waits for frames

    @property
    def accepted(self) -> PublishAccepted:
        """The server's limits."""
        assert self._ledger.accepted is not None  # the constructor waited for it
        return self._ledger.accepted

    @property
    def wanted(self) -> Optional[Wanted]:
        """What would serve the displays of this stream, as told last; None before that."""
        return self._ledger.wanted

    def send(self, sources: Sources, *, capture_time_ns: Optional[int] = None,
             exposure_ev: float = 0.0, tone_map: str = "clip") -> Future[FrameReport]:
        """Sends a frame of one or up to eight sources; its report is the future's result.

        The arrays are copied before this returns. It waits while in_flight_max frames are
        unreported; later frames replace earlier ones that the server has not begun.
        capture_time_ns: any clock of yours, echoed with every atlas; None = time.time_ns().
        exposure_ev:     stops by which linear colour is raised, -32..32.
        tone_map:        "clip", "filmic" or "agx": how linear colour brighter than white is shown.
        Raises BadInput before anything is sent, and ViewloomError when the call has ended; a
        refused frame raises from the future.
        """
        with self._send_lock:
            with self._changed:
                self._changed.wait_for(self._ledger.may_send)
            messages = frame_messages(
                self._ledger.next_number(), sources, exposure_ev=exposure_ev, tone_map=tone_map,
                capture_time_ns=time.time_ns() if capture_time_ns is None else capture_time_ns,
                zstd_level=self._zstd_level)
            with self._changed:
                self._ledger.may_send()  # the call may have ended meanwhile
                promise = self._ledger.open_frame()
            self._frames.put(messages)
            return promise

    def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> None:
        """Waits for the reports of what was sent, and ends the stream.

        Raises what the call ended with, if that was an error.
        """
        self._frames.put(None)
        self._reader.join(timeout_s)
        is_late = self._reader.is_alive()
        self._break_off()
        if is_late:
            raise not_reported(timeout_s)
        if self._error is not None:
            raise self._error

    def _break_off(self) -> None:
        self._is_broken_off = True
        self._call.cancel()  # nothing, if it has ended
        self._reader.join()

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if kind is None:
            self.close()
        else:
            self._break_off()
