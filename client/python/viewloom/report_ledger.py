# SPDX-License-Identifier: Apache-2.0
"""Numbers the frames of one call, and keeps for each the promise of its report."""

from __future__ import annotations

from typing import Any, Callable, Generic, Optional, Protocol, TypeVar

import grpc

from viewloom.errors import ViewloomError
from viewloom.v1 import ingest_service_pb2
from viewloom.v1.ingest_service_pb2 import (FrameReport, PublishAccepted, PublishFramesResponse,
                                            Wanted)


class Promise(Protocol):
    """What concurrent.futures and asyncio futures have in common."""

    def done(self) -> bool: ...

    def set_result(self, result: Any, /) -> None: ...

    def set_exception(self, exception: Any, /) -> None: ...


PromiseT = TypeVar("PromiseT", bound=Promise)


def _settle(promise: Promise, report: FrameReport) -> None:
    if promise.done():  # given up by whoever waited
        return
    if report.outcome == ingest_service_pb2.FRAME_OUTCOME_REFUSED:
        promise.set_exception(ViewloomError(grpc.StatusCode.INVALID_ARGUMENT, "",
                                            f"frame {report.number}: {report.reason}"))
    else:
        promise.set_result(report)


class ReportLedger(Generic[PromiseT]):
    """Which frames of a call are on their way. Thread-safety: none."""

    def __init__(self, make_promise: Callable[[], PromiseT], in_flight_max: int) -> None:
        self._make_promise = make_promise
        self._in_flight_max = in_flight_max
        self._in_flight: dict[int, PromiseT] = {}
        self._last_number = 0
        self.accepted: Optional[PublishAccepted] = None
        self.wanted: Optional[Wanted] = None
        self.ended: Optional[ViewloomError] = None  # why no frame can be sent any more

    def next_number(self) -> int:
        """Of the frame that is opened next."""
        return self._last_number + 1

    def may_send(self) -> bool:
        """Whether there is room for a frame. Raises what the call ended with."""
        if self.ended is not None:
            raise self.ended
        return len(self._in_flight) < self._in_flight_max

    def open_frame(self) -> PromiseT:
        """The promise of the report of frame next_number()."""
        self._last_number += 1
        promise = self._in_flight[self._last_number] = self._make_promise()
        return promise

    def take(self, response: PublishFramesResponse) -> None:
        """Notes an answer, and settles the promise that it is about."""
        kind = response.WhichOneof("message")
        if kind == "accepted":
            self.accepted = response.accepted
        elif kind == "wanted":
            self.wanted = response.wanted
        elif kind == "report":
            promise = self._in_flight.pop(response.report.number, None)
            if promise is not None:
                _settle(promise, response.report)

    def end(self, error: Optional[ViewloomError]) -> None:
        """The call is over: with an error, or, with None, because it was closed."""
        self.ended = error or ViewloomError(grpc.StatusCode.CANCELLED, "",
                                            "the publisher was closed")
        for promise in self._in_flight.values():
            if not promise.done():
                promise.set_exception(self.ended)
        self._in_flight.clear()
