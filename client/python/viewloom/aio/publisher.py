# SPDX-License-Identifier: Apache-2.0
"""Publishes one stream, for asyncio."""

from __future__ import annotations

import asyncio
import time
from types import TracebackType
from typing import Any, Callable, Optional

import grpc

from viewloom.aio.call import read_until_cancelled, until
from viewloom.errors import ViewloomError
from viewloom.frame_messages import Sources, frame_messages, settings_message
from viewloom.publisher import CLOSE_TIMEOUT_S, not_reported
from viewloom.report_ledger import ReportLedger
from viewloom.v1.ingest_service_pb2 import FrameReport, PublishAccepted, Wanted
from viewloom.v1.ingest_service_pb2_grpc import IngestServiceStub


class Publisher:
    """A stream, within `async with`. See Server.publish."""

    def __init__(self, channel: Any, stream: str, session_id: str, zstd_level: int,
                 in_flight_max: int) -> None:
        self._channel = channel
        self._settings = settings_message(stream, session_id)
        self._zstd_level = zstd_level
        self._in_flight_max = in_flight_max

    async def __aenter__(self) -> Publisher:
        make_promise: Callable[[], asyncio.Future[FrameReport]]
        make_promise = asyncio.get_running_loop().create_future
        self._ledger = ReportLedger(make_promise, self._in_flight_max)
        self._send_lock = asyncio.Lock()
        self._changed = asyncio.Event()
        self._call = IngestServiceStub(self._channel).PublishFrames()
        self._reader = asyncio.create_task(self._read())
        await self._write(self._settings)
        await until(self._changed, lambda: bool(self._ledger.accepted or self._ledger.ended))
        if self._ledger.ended is not None:
            raise self._ledger.ended
        return self

    async def _read(self) -> Optional[ViewloomError]:
        def take(response: Any) -> None:
            self._ledger.take(response)
            self._changed.set()

        error = await read_until_cancelled(self._call, take)
        self._ledger.end(error)
        self._changed.set()
        return error

    async def _write(self, message: Any) -> None:
        try:
            await self._call.write(message)
        except (grpc.RpcError, asyncio.InvalidStateError):
            await asyncio.wait({self._reader})  # the call has ended: _read tells all promises why

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
            await until(self._changed, self._ledger.may_send)
            messages = frame_messages(
                self._ledger.next_number(), sources, exposure_ev=exposure_ev, tone_map=tone_map,
                capture_time_ns=time.time_ns() if capture_time_ns is None else capture_time_ns,
                zstd_level=self._zstd_level)
            promise = self._ledger.open_frame()
            for message in messages:
                await self._write(message)
            return promise

    async def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> None:
        """Waits for the reports of what was sent, and ends the stream.

        Raises what the call ended with, if that was an error.
        """
        if not self._reader.done():
            await self._call.done_writing()
            await asyncio.wait({self._reader}, timeout=timeout_s)
        is_late = not self._reader.done()
        self._call.cancel()  # nothing, if it has ended
        error = await self._reader
        if is_late:
            raise not_reported(timeout_s)
        if error is not None:
            raise error

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        if kind is None:
            await self.close()
        else:
            self._call.cancel()
            await self._reader
