# SPDX-License-Identifier: Apache-2.0
"""Watches one stream on one display, for asyncio."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Any, AsyncIterator, Optional

import grpc

from viewloom.aio.call import Line, call_again, until
from viewloom.atlas import Atlas
from viewloom.atlas_inbox import AtlasInbox
from viewloom.clock import (ClockOffset, ServerClock, connection_broke_meanwhile,
                            presented_request, probe_request)
from viewloom.connection import Connection
from viewloom.display import (DisplayLike, EncodingLike, EyeLike, Opening, change_request,
                              eyes_request)
from viewloom.errors import ViewloomError
from viewloom.retry import is_passing
from viewloom.v1.display_service_pb2 import StreamAtlasesRequest
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub


class Watcher(AsyncIterator[Atlas]):
    """Atlases as they come, the newest first, within `async with`. See Server.watch."""

    def __init__(self, connection: Connection, opening: StreamAtlasesRequest,
                 reconnect: bool) -> None:
        self._connection = connection
        self._opening = Opening(opening)
        self._reconnects = reconnect
        self._inbox = AtlasInbox(self._opening.stream)
        self._clock = ServerClock()
        self._is_heard = False   # the server has answered the call that is under way
        self._was_heard = False  # or one before
        self._call_count = 0

    async def __aenter__(self) -> Watcher:
        self._changed = asyncio.Event()
        self._closed = asyncio.Event()
        self._line: Optional[Line] = None
        self._reader = asyncio.create_task(self._run())
        await until(self._changed, lambda: self._line is not None)
        return self

    async def _run(self) -> None:
        error = await call_again(self._run_call, self._is_over, lambda: self._is_heard,
                                 self._closed)
        self._inbox.end(error)
        self._changed.set()

    def _is_over(self, error: ViewloomError) -> bool:
        return not (self._reconnects and self._was_heard and is_passing(error))

    async def _run_call(self) -> Optional[ViewloomError]:
        def take(response: Any) -> None:
            self._is_heard = self._was_heard = True
            if response.HasField("clock_reply"):
                self._clock.add(response.clock_reply)
            else:
                self._inbox.add(response)
            self._changed.set()

        self._inbox.begin_call()
        self._is_heard = False
        self._call_count += 1
        call = DisplayServiceStub(self._connection.channel).StreamAtlases(
            wait_for_ready=self._call_count > 1, metadata=self._connection.metadata)
        self._line = Line(call, self._connection.address, self._opening.requests())
        self._changed.set()
        return await self._line.read(take)

    async def _send(self, request: StreamAtlasesRequest) -> None:
        assert self._line is not None  # __aenter__ waited for it
        self._opening.note(request)
        await self._line.write(request)

    async def receive(self, timeout_s: Optional[float] = None) -> Optional[Atlas]:
        """As the blocking Watcher.receive."""
        try:
            await asyncio.wait_for(until(self._changed, self._inbox.is_ready), timeout_s)
        except asyncio.TimeoutError:
            raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                f"no atlas came within {timeout_s} s") from None
        return self._inbox.take()

    async def __anext__(self) -> Atlas:
        atlas = await self.receive()
        if atlas is None:
            raise StopAsyncIteration
        return atlas

    async def change(self, display: Optional[DisplayLike] = None,
                     encoding: EncodingLike = None) -> None:
        """As the blocking Watcher.change."""
        await self._send(change_request(display, encoding))

    async def send_eye_poses(self, left: EyeLike, right: EyeLike, *, time_ns: int = 0,
                             predicted_display_time_ns: int = 0) -> None:
        """As the blocking Watcher.send_eye_poses."""
        await self._send(eyes_request(left, right, time_ns, predicted_display_time_ns))

    async def report_presented(self, atlas: Atlas, presented_time_ns: int) -> None:
        """As the blocking Watcher.report_presented."""
        await self._send(presented_request(atlas.header.sequence, presented_time_ns))

    async def measure_clock(self, probes: int = 8,
                            timeout_s: Optional[float] = None) -> ClockOffset:
        """As the blocking Watcher.measure_clock."""
        self._clock = ServerClock()
        call_count = self._call_count
        for count in range(1, probes + 1):
            await self._send(probe_request())
            try:
                await asyncio.wait_for(
                    until(self._changed,
                          lambda: self._clock.count >= count or self._inbox.is_ended
                          or self._call_count != call_count), timeout_s)
            except asyncio.TimeoutError:
                raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                    f"no answer came within {timeout_s} s") from None
            self._inbox.raise_if_ended()
            if self._call_count != call_count:
                raise connection_broke_meanwhile()
        return self._clock.offset()

    async def close(self) -> None:
        """Breaks off."""
        self._closed.set()
        if self._line is not None:
            self._line.cut()
        await self._reader

    def __repr__(self) -> str:
        return f"<viewloom.aio.Watcher of {self._opening.stream!r} at {self._connection.address}>"

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        await self.close()
