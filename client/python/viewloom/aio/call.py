# SPDX-License-Identifier: Apache-2.0
"""What the calls of one event loop have in common: reading, and waiting for what was read."""

from __future__ import annotations

import asyncio
from typing import Any, Callable, Optional

import grpc

from viewloom.errors import ViewloomError, error_from_rpc


async def until(changed: asyncio.Event, holds: Callable[[], bool]) -> None:
    """Waits until holds() does; whoever changes what it reads sets the event."""
    while not holds():
        changed.clear()
        await changed.wait()


async def read_all(call: Any, take: Callable[[Any], None]) -> Optional[ViewloomError]:
    """Hands on all answers of a call; what it ended with, None = in order."""
    try:
        async for response in call:
            take(response)
    except grpc.RpcError as problem:
        return error_from_rpc(problem)
    except ViewloomError as problem:
        call.cancel()
        return problem
    return None


async def read_until_cancelled(call: Any, take: Callable[[Any], None]) -> Optional[ViewloomError]:
    """As read_all, in a task of its own; a call that was cancelled here ended in order."""
    try:
        return await read_all(call, take)
    except asyncio.CancelledError:
        call.cancel()
        return None
