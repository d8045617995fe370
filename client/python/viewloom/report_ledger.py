# SPDX-License-Identifier: Apache-2.0
"""Numbers the frames of a stream; keeps each until its report comes, and the one that stands."""

from __future__ import annotations

import dataclasses
from typing import Any, Callable, Generic, Optional, Protocol, TypeVar

import grpc

from viewloom.errors import ViewloomError
from viewloom.send_pace import SendPace
from viewloom.v1 import ingest_service_pb2
from viewloom.v1.ingest_service_pb2 import (FrameReport, PublishAccepted, PublishFramesRequest,
                                            PublishFramesResponse, Wanted)

Messages = list[PublishFramesRequest]


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


@dataclasses.dataclass
class _Frame(Generic[PromiseT]):
    """A frame on its way."""

    messages: Messages
    promise: PromiseT


class ReportLedger(Generic[PromiseT]):
    """Which frames of a stream are on their way, over one call or several. Thread-safety: none."""

    def __init__(self, make_promise: Callable[[], PromiseT], in_flight_max: int) -> None:
        self._make_promise = make_promise
        self._in_flight_max = in_flight_max
        self._in_flight: dict[int, _Frame[PromiseT]] = {}
        self._last_number = 0
        self._standing: Messages = []  # the newest frame that the server has taken
        self.is_open = False  # the server has accepted the call that is under way
        self.accepted: Optional[PublishAccepted] = None
        self.wanted: Optional[Wanted] = None
        self.pace = SendPace()
        self.ended: Optional[ViewloomError] = None  # why no frame can be sent any more

    def next_number(self) -> int:
        """Of the frame that is opened next."""
        return self._last_number + 1

    def may_send(self) -> bool:
        """Whether there is room for a frame. Raises what the call ended with."""
        if self.ended is not None:
            raise self.ended
        return self.is_open and len(self._in_flight) < self._in_flight_max

    def may_leave(self) -> bool:
        """Whether nothing is lost when a call that is broken stays so."""
        return not self.is_open and not self._in_flight

    def open_frame(self, messages: Messages) -> PromiseT:
        """The promise of the report of frame next_number()."""
        self._last_number += 1
        promise = self._make_promise()
        self._in_flight[self._last_number] = _Frame(messages, promise)
        return promise

    def unreported(self) -> list[Messages]:
        """The frames to be sent, in a new call, once more; without any, the one that stands."""
        frames = [self._in_flight[number].messages for number in sorted(self._in_flight)]
        return frames or ([self._standing] if self._standing else [])

    def take(self, response: PublishFramesResponse) -> None:
        """Notes an answer, and settles the promise that it is about."""
        kind = response.WhichOneof("message")
        if kind == "accepted":
            self.accepted, self.is_open = response.accepted, True
        elif kind == "wanted":
            self.wanted = response.wanted
            self.pace.set_rate(response.wanted.rate_hz)
        elif kind == "report":
            frame = self._in_flight.pop(response.report.number, None)
            if frame is not None:
                if response.report.outcome != ingest_service_pb2.FRAME_OUTCOME_REFUSED:
                    self._standing = frame.messages
                _settle(frame.promise, response.report)

    def state(self) -> str:
        """One or two words for people."""
        if self.ended is not None:
            return "ended"
        return f"{self._last_number} frames sent" if self.is_open else "waits for the server"

    def call_ended(self) -> None:
        """A new call may follow."""
        self.is_open = False
        self.pace.set_rate(0)  # until the server says otherwise

    def end(self, error: Optional[ViewloomError]) -> None:
        """The last call is over: with an error, or, with None, because it was closed."""
        self.ended = error or ViewloomError(grpc.StatusCode.CANCELLED, "",
                                            "the publisher was closed")
        for frame in self._in_flight.values():
            if not frame.promise.done():
                frame.promise.set_exception(self.ended)
        self._in_flight.clear()
