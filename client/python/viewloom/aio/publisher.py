# SPDX-License-Identifier: Apache-2.0
"""Publishes one stream, for asyncio."""

from __future__ import annotations

import asyncio
import itertools
import time
from types import TracebackType
from typing import Callable, Optional

from viewloom.aio.call import Line, call_again, until
from viewloom.connection import Connection
from viewloom.errors import ViewloomError
from viewloom.frame_messages import HEARTBEAT, Sources, frame_messages
from viewloom.frame_warnings import FrameWarnings
from viewloom.publisher import CLOSE_TIMEOUT_S, not_reported
from viewloom.report_ledger import ReportLedger
from viewloom.retry import is_passing
from viewloom.v1.ingest_service_pb2 import (FrameReport, PublishAccepted, PublishFramesRequest,
                                            PublishFramesResponse, Wanted)
from viewloom.v1.ingest_service_pb2_grpc import IngestServiceStub

PACE_STEP_S = 0.1  # after which a new rate counts


class Publisher:
    """A stream, within `async with`. See Server.publish."""

    def __init__(self, connection: Connection, settings: PublishFramesRequest, zstd_level: int,
                 in_flight_max: int, reconnect: bool) -> None:
        self._connection = connection
        self._settings = settings
        self._zstd_level = zstd_level
        self._in_flight_max = in_flight_max
        self._reconnects = reconnect
        self._warn_of = FrameWarnings()

    async def __aenter__(self) -> Publisher:
        make_promise: Callable[[], asyncio.Future[FrameReport]]
        make_promise = asyncio.get_running_loop().create_future
        self._ledger = ReportLedger(make_promise, self._in_flight_max)
        self._send_lock = asyncio.Lock()
        self._changed = asyncio.Event()
        self._closed = asyncio.Event()
        self._is_closing = False
        self._was_open = False
        self._line: Optional[Line] = None
        self._reader = asyncio.create_task(self._run())
        await until(self._changed, lambda: bool(self._ledger.accepted or self._ledger.ended))
        if self._ledger.ended is not None:
            raise self._ledger.ended
        return self

    async def _run(self) -> Optional[ViewloomError]:
        error = await call_again(self._run_call, self._is_over, lambda: self._was_open,
                                 self._closed)
        self._ledger.end(error)
        self._changed.set()
        return error

    def _is_over(self, error: ViewloomError) -> bool:
        return not (self._reconnects and self._ledger.accepted and is_passing(error))

    async def _run_call(self) -> Optional[ViewloomError]:
        """One call, with what the server has not reported; None = it ended in order."""
        def take(response: PublishFramesResponse) -> None:
            self._ledger.take(response)
            self._changed.set()

        frames = self._ledger.unreported()
        call = IngestServiceStub(self._connection.channel).PublishFrames(
            wait_for_ready=bool(self._ledger.accepted), metadata=self._connection.metadata)
        line = self._line = Line(call, self._connection.address,
                                 [self._settings, *itertools.chain.from_iterable(frames)])
        closer = asyncio.create_task(line.end_writing()) if self._is_closing else None
        try:
            return await line.read(take, HEARTBEAT)
        finally:
            if closer is not None:
                closer.cancel()
            self._was_open = self._ledger.is_open
            self._ledger.call_ended()
            if self._is_closing and self._ledger.may_leave():
                self._closed.set()

    @property
    def accepted(self) -> PublishAccepted:
        """The server's limits."""
        assert self._ledger.accepted is not None  # __aenter__ waited for it
        return self._ledger.accepted

    @property
    def wanted(self) -> Optional[Wanted]:
        """What would serve the displays of this stream, as told last; None before that."""
        return self._ledger.wanted

    async def send(self, sources: Sources, *, capture_time_ns: Optional[int] = None,
                   exposure_ev: float = 0.0, tone_map: str = "clip") -> asyncio.Future[FrameReport]:
        """As the blocking Publisher.send: `report = await (await publisher.send(source))`."""
        async with self._send_lock:
            await self._wait_for_turn()
            messages = frame_messages(
                self._ledger.next_number(), sources, exposure_ev=exposure_ev, tone_map=tone_map,
                capture_time_ns=time.time_ns() if capture_time_ns is None else capture_time_ns,
                zstd_level=self._zstd_level)
            self._warn_of.frame(sources)
            promise = self._ledger.open_frame(messages)
            assert self._line is not None  # may_send() found it open
            await self._line.write(*messages)  # a call that breaks: the next one takes it over
            return promise

    async def _wait_for_turn(self) -> None:
        """Until there is room for a frame, and the server would use it."""
        while True:
            await until(self._changed, self._ledger.may_send)
            now_s = time.monotonic()
            left_s = self._ledger.pace.left_s(now_s)
            if left_s <= 0:
                self._ledger.pace.note(now_s)
                return
            await asyncio.sleep(min(left_s, PACE_STEP_S))

    async def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> None:
        """Waits for the reports of what was sent, and ends the stream.

        Raises what the call ended with, if that was an error.
        """
        self._is_closing = True
        if self._ledger.may_leave():
            await self._break_off()
        if not self._reader.done():
            if self._line is not None and self._ledger.is_open:
                await self._line.end_writing()
            await asyncio.wait({self._reader}, timeout=timeout_s)
        is_late = not self._reader.done()
        error = await self._break_off()
        if is_late:
            raise not_reported(timeout_s)
        if error is not None:
            raise error

    async def _break_off(self) -> Optional[ViewloomError]:
        self._closed.set()
        if self._line is not None:
            self._line.cut()
        return await self._reader

    def __repr__(self) -> str:
        return (f"<viewloom.aio.Publisher {self._settings.settings.stream!r} at "
                f"{self._connection.address}>")

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        if kind is None:
            await self.close()
        else:
            await self._break_off()
