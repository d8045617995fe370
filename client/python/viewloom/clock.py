# SPDX-License-Identifier: Apache-2.0
"""How far the server's clock is ahead of this process's, from what it says when asked."""

from __future__ import annotations

import dataclasses
import time
from typing import Optional

import grpc

from viewloom.errors import ViewloomError
from viewloom.v1.display_service_pb2 import (ClockProbe, ClockReply, Presented,
                                             StreamAtlasesRequest)


@dataclasses.dataclass(frozen=True)
class ClockOffset:
    """The server's time is time.monotonic_ns() + ahead_ns, to within error_ns."""

    ahead_ns: int
    error_ns: int  # half of what the way there and back took


def probe_request() -> StreamAtlasesRequest:
    """Asks what time it is now."""
    return StreamAtlasesRequest(clock_probe=ClockProbe(client_time_ns=time.monotonic_ns()))


def presented_request(sequence: int, presented_time_ns: int) -> StreamAtlasesRequest:
    """Tells when an atlas was shown."""
    return StreamAtlasesRequest(presented=Presented(sequence=sequence,
                                                    presented_time_ns=presented_time_ns))


def connection_broke_meanwhile() -> ViewloomError:
    """Why a measurement has no result."""
    return ViewloomError(grpc.StatusCode.UNAVAILABLE, "",
                         "the connection broke while the clock was measured: measure it again")


class ServerClock:
    """The answer counts that was on its way for the shortest time. Thread-safety: none."""

    def __init__(self) -> None:
        self.count = 0
        self._best: Optional[ClockOffset] = None

    def add(self, reply: ClockReply) -> None:
        """An answer that comes now."""
        now_ns = time.monotonic_ns()
        at_server_ns = reply.server_sent_ns - reply.server_received_ns
        way_ns = now_ns - reply.client_time_ns - at_server_ns
        ahead_ns = (reply.server_received_ns + reply.server_sent_ns
                    - reply.client_time_ns - now_ns) // 2
        self.count += 1
        if self._best is None or (way_ns + 1) // 2 < self._best.error_ns:
            self._best = ClockOffset(ahead_ns, (way_ns + 1) // 2)

    def offset(self) -> ClockOffset:
        """Expects an answer."""
        assert self._best is not None
        return self._best
