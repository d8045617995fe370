# SPDX-License-Identifier: Apache-2.0
"""What the calls of one event loop have in common: reading, writing, waiting, calling again."""

from __future__ import annotations

import asyncio
from typing import Any, Awaitable, Callable, Optional

import grpc

from viewloom.errors import ViewloomError, error_from_rpc
from viewloom.retry import HEARTBEAT_S, Backoff, SilenceWatch


async def until(changed: asyncio.Event, holds: Callable[[], bool]) -> None:
    """Waits until holds() does; whoever changes what it reads sets the event."""
    while not holds():
        changed.clear()
        await changed.wait()


async def read_all(call: Any, take: Callable[[Any], None], address: str) -> Optional[ViewloomError]:
    """Hands on all answers of a call; what it ended with, None = in order."""
    try:
        async for response in call:
            take(response)
    except grpc.RpcError as problem:
        return error_from_rpc(problem, address)
    except ViewloomError as problem:
        call.cancel()
        return problem
    return None


class Line:
    """One call of two directions. Messages go one after the other; a call that ended takes none."""

    def __init__(self, call: Any, address: str, first: list[Any]) -> None:
        self._call = call
        self._address = address
        self._first = first  # go before all others
        self._write_lock = asyncio.Lock()
        self._is_cut = False
        self._silence = SilenceWatch()

    async def write(self, *messages: Any) -> None:
        """Whoever reads learns how a call ended; here that is no error."""
        async with self._write_lock:
            first, self._first = self._first, []
            try:
                for message in (*first, *messages):
                    await self._call.write(message)
            except (grpc.RpcError, asyncio.InvalidStateError):
                pass
            except asyncio.CancelledError:
                if not self._is_cut:  # then it is the writing task that was cancelled
                    raise

    async def read(self, take: Callable[[Any], None],
                   heartbeat: Any = None) -> Optional[ViewloomError]:
        """As read_all; a server that falls silent is UNAVAILABLE. It is sent heartbeats, if any."""
        def hear(response: Any) -> None:
            self._silence.hears(response.HasField("heartbeat"))
            take(response)

        opener, ticker = (asyncio.create_task(task)
                          for task in (self.write(), self._tick(heartbeat)))
        try:
            return await read_all(self._call, hear, self._address)
        except asyncio.CancelledError:
            if not self._is_cut:
                self._call.cancel()
                raise
            return ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                                 f"nothing more was heard of the server at {self._address}")
        finally:
            opener.cancel()
            ticker.cancel()

    async def _tick(self, heartbeat: Any) -> None:
        while True:
            await asyncio.sleep(HEARTBEAT_S)
            if self._silence.tick():
                self.cut()
            elif heartbeat is not None and self._silence.has_heartbeats:
                if not self._write_lock.locked():  # what is being written says as much
                    await self.write(heartbeat)

    async def end_writing(self) -> None:
        """No message follows."""
        await self.write()
        async with self._write_lock:
            try:
                await self._call.done_writing()
            except (grpc.RpcError, asyncio.InvalidStateError):
                pass

    def cut(self) -> None:
        """Ends the call; nothing, if it has ended."""
        self._is_cut = True
        self._call.cancel()


async def call_again(run_call: Callable[[], Awaitable[Optional[ViewloomError]]],
                     is_over: Callable[[ViewloomError], bool], was_answered: Callable[[], bool],
                     closed: asyncio.Event) -> Optional[ViewloomError]:
    """Runs a call until it ends in order (None), for good, or by closing (None)."""
    backoff = Backoff()
    try:
        while True:
            error = await run_call()
            if closed.is_set() or error is None:
                return None
            if is_over(error):
                return error
            if was_answered():
                backoff.reset()
            try:
                await asyncio.wait_for(closed.wait(), backoff.delay_s(error))
                return None
            except asyncio.TimeoutError:
                pass
    except asyncio.CancelledError:  # the event loop ends
        return None
