# SPDX-License-Identifier: Apache-2.0
"""When a broken call is made again, and how to notice that the server has fallen silent."""

from __future__ import annotations

import random

import grpc

from viewloom.errors import ViewloomError

_FIRST_DELAY_S = 0.1
_DELAY_MAX_S = 1.0  # so that everybody is back within 2 s of the server's return
_FACTOR = 2.0

HEARTBEAT_S = 1.0
_SILENT_HEARTBEATS_MAX = 5

_BROKEN_BY_TRANSPORT = (grpc.StatusCode.UNKNOWN, grpc.StatusCode.INTERNAL,
                        grpc.StatusCode.DEADLINE_EXCEEDED)


def is_passing(error: ViewloomError) -> bool:
    """Whether the same call may succeed later.

    What the server itself refuses may not, unless it drains or says when to ask again; what a
    proxy or the connection did to a call may.
    """
    if error.retry_delay_s is not None or error.status == grpc.StatusCode.UNAVAILABLE:
        return True
    if error.is_from_server:
        return False
    if error.status == grpc.StatusCode.RESOURCE_EXHAUSTED:  # a message too large stays that
        return "larger than max" not in error.message
    return error.status in _BROKEN_BY_TRANSPORT


class Backoff:
    """Delays between calls: they grow, and differ from client to client."""

    def __init__(self) -> None:
        self._mean_s = _FIRST_DELAY_S

    def reset(self) -> None:
        """The last call was answered: the next failure is a new one."""
        self._mean_s = _FIRST_DELAY_S

    def delay_s(self, error: ViewloomError) -> float:
        """Of the call after this error."""
        if error.retry_delay_s is not None:
            return error.retry_delay_s
        mean_s = self._mean_s
        self._mean_s = min(mean_s * _FACTOR, _DELAY_MAX_S)
        return mean_s * random.uniform(0.5, 1.5)


class SilenceWatch:
    """Counts the heartbeats that a server owes. Servers that send none may be silent.

    Ticks are counted, not time: a program that was stopped for a while has missed nothing.
    Thread-safety: hears() and tick() may be called from two threads.
    """

    def __init__(self) -> None:
        self._has_heartbeats = False
        self._ticks = 0

    @property
    def has_heartbeats(self) -> bool:
        """Whether the server sends them, and so takes them."""
        return self._has_heartbeats

    def hears(self, is_heartbeat: bool) -> None:
        """A message came."""
        self._ticks = 0
        self._has_heartbeats |= is_heartbeat

    def tick(self) -> bool:
        """To be called every HEARTBEAT_S: whether the server has been silent for too long."""
        self._ticks += 1
        return self._has_heartbeats and self._ticks > _SILENT_HEARTBEATS_MAX
