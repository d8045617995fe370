# SPDX-License-Identifier: Apache-2.0
"""Viewers that hardly read, on connections of their own, in one thread that costs little."""

import contextlib
import struct
import threading

from google.protobuf import json_format

from attack_parts import http2
from clients import WATCH
from viewloom.v1 import display_service_pb2

LARGEST_WINDOW = (1 << 31) - 1
OUR_WINDOW = LARGEST_WINDOW - 65535  # beside what a connection begins with
STEP_S = 0.25
PINGS_FAKED = 40  # the first pings of a connection that a fake acknowledges
SLOW_BYTES = 4096  # each step


def open_message(stream, display):
    request = display_service_pb2.StreamAtlasesRequest()
    request.open.stream = stream
    json_format.ParseDict(display, request.open.display)
    message = request.SerializeToString()
    return b"\0" + struct.pack("!I", len(message)) + message


class Frames:
    """Cuts what is read into frames, and keeps no payload but that of pings."""

    def __init__(self):
        self._left = b""

    def pings(self, data):
        """Pings among the frames that have come whole."""
        self._left += data
        while len(self._left) >= 9:
            size = int.from_bytes(self._left[:3], "big")
            if len(self._left) < 9 + size:
                return
            if self._left[3] == http2.PING and not self._left[4] & http2.ACK:
                yield self._left[9:17]
            self._left = self._left[9 + size:]


class StalledViewer:
    """Opens a display."""

    window = 65535

    def __init__(self, address, message):
        settings = struct.pack("!HI", http2.INITIAL_WINDOW_SIZE, self.window)
        self.connection = http2.Connection(address, settings)
        self.connection.socket.setblocking(False)
        self.send(http2.frame(http2.SETTINGS, http2.ACK, 0) +
                  http2.frame(http2.HEADERS, http2.END_HEADERS, 1, http2.call_headers(WATCH)) +
                  http2.frame(http2.DATA, 0, 1, message))

    def send(self, data):
        with contextlib.suppress(OSError):  # full, or cut
            self.connection.socket.send(data)

    def read(self, size):
        with contextlib.suppress(OSError):
            return self.connection.socket.recv(size)
        return b""

    def step(self):
        """Called every STEP_S."""

    def close(self):
        self.connection.socket.close()


class Silent(StalledViewer):
    """Neither reads nor answers."""


class Faker(StalledViewer):
    """Never reads, and acknowledges what it has not read: pings, and the flow of data."""

    window = LARGEST_WINDOW

    def __init__(self, address, message):
        super().__init__(address, message)
        self.send(http2.frame(http2.WINDOW_UPDATE, 0, 0, struct.pack("!I", OUR_WINDOW)))
        self._acks = b"".join(http2.frame(http2.PING, http2.ACK, 0, struct.pack("!Q", number))
                              for number in range(PINGS_FAKED))

    def step(self):
        self.send(self._acks)


class Waiting(StalledViewer):
    """Answers pings, and never lets the server send more than the first window."""

    def __init__(self, address, message):
        super().__init__(address, message)
        self._frames = Frames()

    def step(self):
        for ping in self._frames.pings(self.read(65536)):
            self.send(http2.frame(http2.PING, http2.ACK, 0, ping))


class Slow(StalledViewer):
    """Reads a little each time, and answers pings. It is not to be cut."""

    def __init__(self, address, message):
        super().__init__(address, message)
        self._frames = Frames()

    def step(self):
        data = self.read(SLOW_BYTES)
        for ping in self._frames.pings(data):
            self.send(http2.frame(http2.PING, http2.ACK, 0, ping))
        if data:
            size = struct.pack("!I", len(data))
            for stream in (0, 1):
                self.send(http2.frame(http2.WINDOW_UPDATE, 0, stream, size))


class Crowd:
    """So many viewers of each kind, {kind: count}."""

    def __init__(self, address, stream, display, counts):
        message = open_message(stream, display)
        self.viewers = [kind(address, message) for kind, count in counts.items()
                        for _ in range(count)]
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._stopping.wait(STEP_S):
            for viewer in self.viewers:
                viewer.step()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stopping.set()
        self._thread.join()
        for viewer in self.viewers:
            viewer.close()
