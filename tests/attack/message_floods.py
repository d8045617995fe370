# SPDX-License-Identifier: Apache-2.0
"""Messages of gRPC that cost their receiver more than their sender."""

import contextlib
import queue

import grpc
import numpy as np

import viewloom
from viewloom.v1 import (display_service_pb2, display_service_pb2_grpc, ingest_service_pb2,
                         ingest_service_pb2_grpc)


class Feed:
    """The messages of one call, which goes on until close()."""

    def __init__(self, *messages):
        self._messages = queue.Queue()
        for message in messages:
            self.put(message)

    def put(self, message):
        self._messages.put(message)

    def __iter__(self):
        return iter(self._messages.get, None)

    def close(self):
        self._messages.put(None)


def gzip_messages(address, budget):
    """Messages of zeros, packed a thousand to one."""
    found = []
    is_over = budget.deadline()
    padding = "0" * (64 << 20)
    request = display_service_pb2.StreamAtlasesRequest()
    request.open.stream = padding
    with address.channel(**{"grpc.max_send_message_length": -1}) as channel:
        for compression in (grpc.Compression.Gzip, grpc.Compression.Deflate):
            if is_over():
                break
            feed = Feed(request)
            call = display_service_pb2_grpc.DisplayServiceStub(channel).StreamAtlases(
                iter(feed), compression=compression, timeout=5)
            found += found_in_refusal(call, compression)
            feed.close()
            call.cancel()
    return found


def found_in_refusal(call, compression):
    """A compressed message has to be refused as such, before it is unpacked."""
    try:
        next(call)
    except grpc.RpcError as error:
        # A front answers by itself.
        if error.code() in (grpc.StatusCode.UNIMPLEMENTED, grpc.StatusCode.INTERNAL):
            return []
        return [f"{compression.name}: {error.code().name} instead of UNIMPLEMENTED"]
    return [f"{compression.name} was unpacked"]


def claims(address, budget):
    """Streams that are claimed, without a frame."""
    is_over = budget.deadline()
    feeds = []
    with address.channel() as channel:
        stub = ingest_service_pb2_grpc.IngestServiceStub(channel)
        for number in range(budget.count(14, 200)):
            settings = ingest_service_pb2.PublishFramesRequest()
            settings.settings.stream = f"claimed{number}"
            feed = Feed(settings)
            feeds.append(feed)
            with contextlib.suppress(grpc.RpcError, StopIteration):
                next(stub.PublishFrames(iter(feed), timeout=budget.seconds))
            if is_over():
                break
        for feed in feeds:
            feed.close()
    return []


def long_names(address, _budget):
    """Names in letters that trailers write with nine bytes each."""
    found = []
    with address.channel() as channel:
        request = display_service_pb2.StreamAtlasesRequest()
        request.open.stream = "healthy"
        request.open.display.quilt.preset = "光" * 500
        feed = Feed(request)
        try:
            next(display_service_pb2_grpc.DisplayServiceStub(channel).StreamAtlases(
                iter(feed), timeout=5))
        except grpc.RpcError as error:
            if error.code() != grpc.StatusCode.NOT_FOUND:
                found.append(f"a long name of a preset: {error.code().name} instead of NOT_FOUND")
        feed.close()
    return found


def plane_bombs(address, budget):
    """Planes of one value, which zstd packs a thousand to one."""
    side_px = 1024 if budget.scale == 1 else 4096
    color = np.zeros((side_px, side_px, 3), np.uint8)
    depth_m = np.ones((side_px, side_px), np.float32)
    is_over = budget.deadline()
    with viewloom.connect(f"{address.host}:{address.grpc_port}") as server:
        for number in range(budget.count(3, 8)):
            with contextlib.suppress(viewloom.ViewloomError), \
                    server.publish(f"bomb{number}", zstd_level=3) as publisher:
                publisher.send(viewloom.Source(color, depth_m, fov_y_rad=0.9)).result(5)
            if is_over():
                break
    return []


ATTACKS = (gzip_messages, claims, long_names, plane_bombs)
