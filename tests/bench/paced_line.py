# SPDX-License-Identifier: Apache-2.0
"""A line of a given speed from a server on this machine: a TCP proxy."""

import contextlib
import socket
import threading
import time

CHUNK_BYTES = 8192
# Buffers of the kernel before the line, so that the server sees how slow it is.
BUFFER_BYTES = 1 << 16


class PacedLine:
    """What comes from the server takes as long as on a line of so many Mbit/s. What goes to it does
    not wait."""

    def __init__(self, target, mbit_per_s):
        host, port = target.rsplit(":", 1)
        self._target = (host, int(port))
        self._s_per_byte = 8e-6 / mbit_per_s
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self._listener.getsockname()[1]
        self._sockets = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        with contextlib.suppress(OSError):  # closed
            while True:
                client, _ = self._listener.accept()
                server = socket.socket()
                server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
                server.connect(self._target)
                self._sockets += [client, server]
                for one in (client, server):
                    one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                for carry, ends in ((_carry, (client, server)), (self._pace, (server, client))):
                    threading.Thread(target=carry, args=ends, daemon=True).start()

    def _pace(self, source, target):
        """Hands on each byte when its last bit would have come."""
        free_s = time.monotonic()
        with contextlib.suppress(OSError):
            while data := source.recv(CHUNK_BYTES):
                free_s = max(free_s, time.monotonic()) + len(data) * self._s_per_byte
                time.sleep(max(0.0, free_s - time.monotonic()))
                target.sendall(data)
        _end(target)

    def close(self):
        """Ends it, and the connections on it."""
        for one in [self._listener, *self._sockets]:
            _end(one)
            one.close()


def _carry(source, target):
    with contextlib.suppress(OSError):
        while data := source.recv(CHUNK_BYTES):
            target.sendall(data)
    _end(target)


def _end(one):
    with contextlib.suppress(OSError):
        one.shutdown(socket.SHUT_RDWR)
