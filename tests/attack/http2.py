# SPDX-License-Identifier: Apache-2.0
"""Frames of HTTP/2 (RFC 9113) and headers (RFC 7541), as few as the floods need."""

import contextlib
import socket
import ssl
import struct
import time

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DATA, HEADERS, RST_STREAM, SETTINGS, PING, WINDOW_UPDATE, CONTINUATION = 0, 1, 3, 4, 6, 8, 9
END_STREAM, ACK, END_HEADERS = 1, 1, 4
INITIAL_WINDOW_SIZE = 4  # a setting
CANCEL = 8
FRAME_BYTES_MAX = 16384
LINGER_S = 1.0


def frame(kind, flags, stream, payload=b""):
    return struct.pack("!I", len(payload))[1:] + struct.pack("!BBI", kind, flags, stream) + payload



def text(value):
    """A string of HPACK, without Huffman's code."""
    value = value.encode() if isinstance(value, str) else value
    return integer(len(value), 7) + value


def integer(value, prefix_bits, flags=0):
    most = (1 << prefix_bits) - 1
    if value < most:
        return bytes([flags | value])
    out, value = bytearray([flags | most]), value - most
    while value >= 128:
        out.append(value % 128 + 128)
        value //= 128
    return bytes(out + bytes([value]))


def literal(name, value, is_kept=False):
    """A header that is not in the static table. is_kept: the peer adds it to its table."""
    return (b"\x40" if is_kept else b"\x00") + text(name) + text(value)


def call_headers(path, authority="localhost", scheme="http"):
    """A call of gRPC. 0x83 is POST; 6 and 7 are the schemes."""
    return (b"\x83" + (b"\x86" if scheme == "http" else b"\x87") + b"\x04" + text(path) +
            b"\x01" + text(authority) + literal("te", "trailers") +
            literal("content-type", "application/grpc"))


class Connection:
    """A connection after its preface. Ends without a word when the peer closes it."""

    def __init__(self, address, first_settings=b""):
        self.socket = address.connect()
        self.socket.settimeout(0.5)
        self.is_open = True
        self.scheme = "http" if address.tls is None else "https"
        self.send(PREFACE + frame(SETTINGS, 0, 0, first_settings))

    def send(self, data):
        """False when the peer takes nothing more."""
        if not self.is_open:
            return False
        try:
            self.socket.sendall(data)
            return True
        except (OSError, ssl.SSLError):
            self.is_open = False
            return False

    def read(self, size=65536):
        """What has come; b"" if nothing."""
        with contextlib.suppress(OSError, ssl.SSLError):
            return self.socket.recv(size)
        return b""

    def close(self):
        """Lets the peer work off what was sent: a connection that is cut at once costs nothing."""
        end_s = time.monotonic() + LINGER_S
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_WR)
            while time.monotonic() < end_s and self.read():
                pass
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
