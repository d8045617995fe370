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

from viewloom.connection import Connection
from viewloom.errors import ViewloomError, error_from_rpc
from viewloom.frame_messages import HEARTBEAT, Sources, frame_messages
from viewloom.frame_warnings import FrameWarnings
from viewloom.report_ledger import Messages, ReportLedger
from viewloom.retry import HEARTBEAT_S, Backoff, SilenceWatch, is_passing
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

    def __init__(self, connection: Connection, settings: PublishFramesRequest, zstd_level: int,
                 in_flight_max: int, reconnect: bool) -> None:
        self._connection = connection
        self._settings = settings
        self._zstd_level = zstd_level
        self._reconnects = reconnect
        self._warn_of = FrameWarnings()
        self._send_lock = threading.Lock()
        self._changed = threading.Condition()
        self._ledger = ReportLedger(_make_promise, in_flight_max)
        self._outbox: queue.SimpleQueue[Optional[Messages]] = queue.SimpleQueue()
        self._call: Any = None
        self._is_closing = False
        self._broken_off = threading.Event()
        self._error: Optional[ViewloomError] = None
        self._reader = threading.Thread(target=self._run, name="viewloom-publisher", daemon=True)
        self._reader.start()
        with self._changed:
            self._changed.wait_for(lambda: self._ledger.accepted or self._ledger.ended)
        if self._error is not None:
            raise self._error

    def _run(self) -> None:
        backoff = Backoff()
        while True:
            error = self._run_call()
            with self._changed:
                was_open = self._ledger.is_open
                self._ledger.call_ended()
                may_leave = self._is_closing and self._ledger.may_leave()
            if self._broken_off.is_set() or error is None:
                error = None
                break
            if not (self._reconnects and self._ledger.accepted and is_passing(error)):
                break
            if was_open:
                backoff.reset()
            if may_leave:
                error = None
                break
            self._broken_off.wait(backoff.delay_s(error))
        with self._changed:
            self._error = error
            self._ledger.end(error)
            self._changed.notify_all()

    def _run_call(self) -> Optional[ViewloomError]:
        """One call, with what the server has not reported; None = it ended in order.

        All but the first wait in the channel, which finds the server within 0.3 s of its return.
        """
        outbox: queue.SimpleQueue[Optional[Messages]] = queue.SimpleQueue()
        silence = SilenceWatch()
        with self._changed:
            if self._broken_off.is_set():
                return None
            for messages in self._ledger.unreported():
                outbox.put(messages)
            if self._is_closing:
                outbox.put(None)
            self._outbox = outbox
            self._call = IngestServiceStub(self._connection.channel).PublishFrames(
                self._requests(outbox, silence), wait_for_ready=bool(self._ledger.accepted),
                metadata=self._connection.metadata)
        try:
            for response in self._call:
                silence.hears(response.HasField("heartbeat"))
                with self._changed:
                    self._ledger.take(response)
                    self._changed.notify_all()
        except grpc.RpcError as problem:
            return error_from_rpc(problem, self._connection.address)
        finally:
            outbox.put(None)  # lets go of the thread that waits for frames
        return None

    def _requests(self, outbox: queue.SimpleQueue[Optional[Messages]],
                  silence: SilenceWatch) -> Iterator[PublishFramesRequest]:
        yield self._settings
        while True:
            try:
                messages = outbox.get(timeout=HEARTBEAT_S)
            except queue.Empty:
                if silence.tick():
                    self._call.cancel()
                if silence.has_heartbeats:
                    yield HEARTBEAT
                continue
            if messages is None:
                return
            yield from messages

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
        unreported, while the server is away, and until the server would use another frame
        (wanted.rate_hz; about one a second while nobody watches). Later frames replace earlier
        ones that the server has not begun. Warns (UnlikelyInput) of a frame that shows nothing,
        once a stream.
        capture_time_ns: any clock of yours, echoed with every atlas; None = time.time_ns().
        exposure_ev:     stops by which linear colour is raised, -32..32.
        tone_map:        "clip", "filmic" or "agx": how linear colour brighter than white is shown.
        Raises BadInput before anything is sent, and ViewloomError when the call has ended; a
        refused frame raises from the future.
        """
        with self._send_lock:
            self._wait_for_turn()
            messages = frame_messages(
                self._ledger.next_number(), sources, exposure_ev=exposure_ev, tone_map=tone_map,
                capture_time_ns=time.time_ns() if capture_time_ns is None else capture_time_ns,
                zstd_level=self._zstd_level)
            self._warn_of.frame(sources)
            with self._changed:
                if self._ledger.ended is not None:
                    raise self._ledger.ended
                promise = self._ledger.open_frame(messages)
                self._outbox.put(messages)  # of a call that broke: the next one takes it from there
            return promise

    def _wait_for_turn(self) -> None:
        """Until there is room for a frame, and the server would use it."""
        with self._changed:
            while True:
                self._changed.wait_for(self._ledger.may_send)
                now_s = time.monotonic()
                left_s = self._ledger.pace.left_s(now_s)
                if left_s <= 0:
                    self._ledger.pace.note(now_s)
                    return
                self._changed.wait(left_s)

    def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> None:
        """Waits for the reports of what was sent, and ends the stream.

        Raises what the call ended with, if that was an error.
        """
        with self._changed:
            self._is_closing = True
            self._outbox.put(None)
            has_nothing_to_lose = self._ledger.may_leave()
        if has_nothing_to_lose:
            self._break_off()
        self._reader.join(timeout_s)
        is_late = self._reader.is_alive()
        self._break_off()
        if is_late:
            raise not_reported(timeout_s)
        if self._error is not None:
            raise self._error

    def _break_off(self) -> None:
        with self._changed:
            self._broken_off.set()
            self._call.cancel()  # nothing, if it has ended
        self._reader.join()

    def __repr__(self) -> str:
        return (f"<viewloom.Publisher {self._settings.settings.stream!r} at "
                f"{self._connection.address}, {self._ledger.state()}>")

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if kind is None:
            self.close()
        else:
            self._break_off()
