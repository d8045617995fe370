# SPDX-License-Identifier: Apache-2.0
"""Watches one stream on one display, for asyncio."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Any, AsyncIterator, Optional

import grpc

from viewloom.aio.call import read_until_cancelled, until
from viewloom.atlas import Atlas
from viewloom.atlas_inbox import AtlasInbox
from viewloom.clock import ClockOffset, ServerClock, presented_request, probe_request
from viewloom.display import (DisplayLike, EncodingLike, EyeLike, change_request,
                              eyes_request)
from viewloom.errors import ViewloomError
from viewloom.v1.display_service_pb2 import StreamAtlasesRequest
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub


class Watcher(AsyncIterator[Atlas]):
    """Atlases as they come, the newest first, within `async with`. See Server.watch."""

    def __init__(self, channel: Any, opening: StreamAtlasesRequest) -> None:
        self._channel = channel
        self._opening = opening
        self._inbox = AtlasInbox()
        self._clock = ServerClock()

    async def __aenter__(self) -> Watcher:
        self._changed = asyncio.Event()
        self._call = DisplayServiceStub(self._channel).StreamAtlases()
        self._reader = asyncio.create_task(self._read())
        await self._write(self._opening)
        return self

    async def _read(self) -> None:
        def take(response: Any) -> None:
            if response.HasField("clock_reply"):
                self._clock.add(response.clock_reply)
            else:
                self._inbox.add(response)
            self._changed.set()

        self._inbox.end(await read_until_cancelled(self._call, take))
        self._changed.set()

    async def _write(self, request: StreamAtlasesRequest) -> None:
        try:
            await self._call.write(request)
        except (grpc.RpcError, asyncio.InvalidStateError):
            pass  # the call has ended: receive() says why

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
        await self._write(change_request(display, encoding))

    async def send_eye_poses(self, left: EyeLike, right: EyeLike, *, time_ns: int = 0,
                             predicted_display_time_ns: int = 0) -> None:
        """As the blocking Watcher.send_eye_poses."""
        await self._write(eyes_request(left, right, time_ns, predicted_display_time_ns))

    async def report_presented(self, atlas: Atlas, presented_time_ns: int) -> None:
        """As the blocking Watcher.report_presented."""
        await self._write(presented_request(atlas.header.sequence, presented_time_ns))

    async def measure_clock(self, probes: int = 8,
                            timeout_s: Optional[float] = None) -> ClockOffset:
        """As the blocking Watcher.measure_clock."""
        self._clock = ServerClock()
        for count in range(1, probes + 1):
            await self._write(probe_request())
            try:
                await asyncio.wait_for(
                    until(self._changed,
                          lambda: self._clock.count >= count or self._inbox.is_ended), timeout_s)
            except asyncio.TimeoutError:
                raise ViewloomError(grpc.StatusCode.DEADLINE_EXCEEDED, "",
                                    f"no answer came within {timeout_s} s") from None
            self._inbox.raise_if_ended()
        return self._clock.offset()

    async def close(self) -> None:
        """Breaks off."""
        self._call.cancel()
        await self._reader

    async def __aexit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                        trace: Optional[TracebackType]) -> None:
        await self.close()
