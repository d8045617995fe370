# SPDX-License-Identifier: Apache-2.0
"""Clients that do what they should: each comes, does something and goes."""

import contextlib
import random
from dataclasses import dataclass

import grpc

import healthy_pair
import viewloom
from displays import DISPLAYS, EYE_POSES
from message_floods import Feed
from viewloom.display import display_from
from viewloom.v1 import (display_service_pb2, display_service_pb2_grpc, ingest_service_pb2,
                         ingest_service_pb2_grpc)

PATIENCE_S = 60
STREAMS_MAX = 16  # the default of the server
# Without kernels that take seconds to compile.
SWEPT = ("quilt", "quilt-top-left", "quilt-wide", "quilt-background")
PLAIN = DISPLAYS["quilt"]
TRACKED = {"stereo": {**DISPLAYS["stereo"]["stereo"], "tracked": True}}


@dataclass
class Visit:
    """What a client is given. stream: nobody else publishes it meanwhile. number: of the cycle."""
    place: object
    stream: str
    number: int
    random: random.Random
    kinds: tuple = tuple(DISPLAYS)

    def kind(self, offset=0):
        """A display; all have their turn."""
        return DISPLAYS[self.kinds[(self.number + offset) % len(self.kinds)]]

    @contextlib.contextmanager
    def publishing(self, **options):
        """The stream, with one frame that stands."""
        with self.place.connect() as server, \
                server.publish(self.stream, **options) as publisher:
            publisher.send(healthy_pair.source(self.number)).result(PATIENCE_S)
            yield server

    @contextlib.contextmanager
    def call(self, method, *messages):
        """A call of gRPC that stays open: "watch" or "publish"."""
        stubs = {"watch": (display_service_pb2_grpc.DisplayServiceStub, "StreamAtlases"),
                 "publish": (ingest_service_pb2_grpc.IngestServiceStub, "PublishFrames")}
        stub, name = stubs[method]
        feed = Feed(*messages)
        with self.place.address.channel() as channel:
            call = getattr(stub(channel), name)(iter(feed), timeout=PATIENCE_S,
                                                metadata=self.place.metadata)
            try:
                yield call, feed
            finally:
                call.cancel()
                feed.close()


def opening(stream, display=None):
    """What a call that watches begins with."""
    return display_service_pb2.StreamAtlasesRequest(open={
        "stream": stream, "display": display_from(display or PLAIN), "wait_for_stream": True})


def settings(stream, session=""):
    """What a call that publishes begins with."""
    return ingest_service_pb2.PublishFramesRequest(
        settings={"stream": stream, "session_id": session})


def first_answer_code(call):
    """The code of the error that ends a call; OK once it has answered."""
    try:
        next(call)
        return grpc.StatusCode.OK
    except StopIteration:
        return grpc.StatusCode.OK
    except grpc.RpcError as error:
        return error.code()


def watch_and_change(visit):
    """A display of one kind, then of another."""
    with visit.publishing() as server, server.watch(visit.stream, visit.kind()) as watcher:
        watcher.receive(PATIENCE_S)
        watcher.change(visit.kind(1))
        watcher.receive(PATIENCE_S)


def show_still(visit):
    with visit.publishing(zstd_level=1) as server:
        server.still(visit.stream, visit.kind(), encoding=viewloom.encoding(lossless=True),
                     timeout_s=PATIENCE_S)


def share_display(visit):
    """Three viewers of one display; two leave before the third."""
    with visit.publishing() as server, contextlib.ExitStack() as others:
        with server.watch(visit.stream, visit.kind()) as last:
            for _ in range(2):
                others.enter_context(server.watch(visit.stream, visit.kind()))
            last.receive(PATIENCE_S)
            others.close()


def track_eyes(visit):
    """A tracked pair, with poses of its eyes."""
    with visit.publishing() as server, server.watch(visit.stream, TRACKED) as watcher:
        for number, (left, right) in enumerate(EYE_POSES):
            places = [[eye["pose"]["position"][axis] for axis in "xyz"] for eye in (left, right)]
            watcher.send_eye_poses(*places, time_ns=visit.number + number + 1)
        watcher.receive(PATIENCE_S)


def measure_clock(visit):
    with visit.publishing() as server, server.watch(visit.stream, PLAIN) as watcher:
        watcher.receive(PATIENCE_S)
        watcher.measure_clock(2, PATIENCE_S)


def read_lists(visit):
    with visit.place.connect() as server:
        server.streams()
        server.displays()
        server.presets()
        server.server_info()


def take_over(visit):
    """The stream goes to another call of the same session."""
    with visit.call("publish", settings(visit.stream, "session")) as (first, _):
        next(first)
        with visit.call("publish", settings(visit.stream, "session")) as (second, _):
            next(second)


def wait_for_nobody(visit):
    """A display of a stream that does not come."""
    with visit.call("watch", opening(f"{visit.stream}.nobody")):
        pass


def leave_alike(place, count):
    """A server keeps the newest frame of each stream, as many as it may have. After so many streams
    they are always the same ones."""
    with place.connect() as server:
        for number in range(count):
            with server.publish(f"kept.{number}") as publisher:
                publisher.send(healthy_pair.source(0)).result(PATIENCE_S)


def show_all(visit):
    """Every kind once: kernels are compiled, and caches are filled."""
    with visit.publishing() as server:
        for name in visit.kinds:
            for lossless in (False, True):
                with contextlib.suppress(viewloom.ViewloomError):  # JPEG does not serve all kinds
                    server.still(visit.stream, DISPLAYS[name], timeout_s=PATIENCE_S,
                                 encoding=viewloom.encoding(lossless=lossless))


VISITS = (watch_and_change, show_still, share_display, track_eyes, measure_clock, read_lists,
          take_over, wait_for_nobody)
# Without kernels: what a server can do right after its start.
SWEPT_VISITS = tuple(one for one in VISITS if one is not track_eyes)
