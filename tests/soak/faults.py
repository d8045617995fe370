# SPDX-License-Identifier: Apache-2.0
"""Clients that break off, send nonsense or never read: each comes, does something and goes."""

import contextlib
import math
import socket
import struct
import time

import grpc

import healthy_pair
import http2
from http2 import DATA, END_HEADERS, HEADERS, frame
from viewloom.frame_messages import frame_messages
from visits import PATIENCE_S, first_answer_code, opening, settings

OK, BAD = grpc.StatusCode.OK, grpc.StatusCode.INVALID_ARGUMENT
WATCH_PATH = "/viewloom.v1.DisplayService/StreamAtlases"
UNREAD_FRAMES = 2


def messages(visit):
    return frame_messages(visit.number + 1, healthy_pair.source(visit.number), capture_time_ns=1)


def expect(name, code, *accepted):
    if code not in accepted:
        raise RuntimeError(f"{name} ended with {code.name}")


def half_frame(visit):
    """A header and the first half of a plane, then nothing."""
    header, color, *_ = messages(visit)
    color.chunk.data = color.chunk.data[:len(color.chunk.data) // 2]
    with visit.call("publish", settings(visit.stream), header, color) as (call, _):
        next(call)


def bad_header(visit):
    """A frame that cannot be: refused, and the call ends."""
    header, *_ = messages(visit)
    plane = header.header.sources[0].layers[0].planes[visit.random.randrange(2)]
    spoil = visit.random.randrange(3)
    if spoil == 0:
        plane.size.width = 0
    elif spoil == 1:
        plane.bytes_count += 1
    else:
        header.header.sources[0].camera.fov.angle_left_rad = math.nan
    with visit.call("publish", settings(visit.stream), header) as (call, feed):
        next(call)  # accepted
        feed.close()
        expect("a bad header", first_refusal(call), BAD)


def bad_chunk(visit):
    """Bytes beyond their plane."""
    header, color, *_ = messages(visit)
    color.chunk.offset_bytes = 1 << 40
    with visit.call("publish", settings(visit.stream), header, color) as (call, feed):
        next(call)
        feed.close()
        expect("a bad chunk", first_refusal(call), BAD)


def first_refusal(call):
    """The code that ends a call, whatever it answers before."""
    try:
        for _ in call:
            pass
        return OK
    except grpc.RpcError as error:
        return error.code()


def bad_display(visit):
    """A display that cannot be."""
    request = opening(visit.stream)
    request.open.display.quilt.columns = 10_000
    with visit.call("watch", request) as (call, _):
        expect("a bad display", first_answer_code(call), BAD)


def abort_call(visit):
    """A call that ends before it has been answered."""
    method, first = visit.random.choice((("watch", opening(visit.stream)),
                                         ("publish", settings(visit.stream))))
    with visit.call(method, first):
        time.sleep(visit.random.random() * 0.01)


def never_read(visit):
    """A viewer that does not take its pictures."""
    with visit.place.connect() as server, server.publish(visit.stream) as publisher, \
            visit.call("watch", opening(visit.stream, visit.kind())):
        for number in range(UNREAD_FRAMES):
            publisher.send(healthy_pair.source(number)).result(PATIENCE_S)


def cut_connection(visit):
    """HTTP/2 that ends amid a message, by a reset."""
    connection = http2.Connection(visit.place.address)
    connection.send(frame(HEADERS, END_HEADERS, 1,
                          http2.call_headers(WATCH_PATH, scheme=connection.scheme)))
    message = opening(visit.stream).SerializeToString()
    whole = struct.pack("!BI", 0, len(message) + 100) + message
    connection.send(frame(DATA, 0, 1, whole[:visit.random.randrange(1, len(whole))]))
    connection.read()
    with contextlib.suppress(OSError):
        connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.socket.close()


def nonsense(visit):
    """Bytes that are no HTTP/2, and a connection that says nothing."""
    for text in (visit.random.randbytes(200), b""):
        with visit.place.address.connect() as one:
            one.sendall(text)


FAULTS = (half_frame, bad_header, bad_chunk, bad_display, abort_call, never_read, cut_connection,
          nonsense)
