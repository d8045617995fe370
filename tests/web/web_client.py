# SPDX-License-Identifier: Apache-2.0
"""A foreign HTTP and WebSocket client on plain sockets, and the server under test as a process."""
import contextlib
import base64
import contextlib
import json
import os
import socket
import struct
import subprocess
from urllib.parse import urlencode, urljoin, urlsplit

TIMEOUT_S = 60  # of any single wait; a test that reaches it has failed


def asked(display=None, encoding=None, stream="painted", **others):
    """Parameters of /ws, a still, or the page: messages as JSON."""
    parameters = {"stream": stream} if stream else {}
    parameters.update(others)
    for name, message in (("display", display), ("encoding", encoding)):
        if message is not None:
            parameters[name] = json.dumps(message)
    return urlencode(parameters)


def quilt(columns, rows, width, height, beside=None, **fields):
    """A quilt of that grid and size as a Display; beside: fields of the Display."""
    return {"quilt": {"columns": columns, "rows": rows,
                      "size": {"width": width, "height": height}, **fields}, **(beside or {})}


class Server:
    """A program that prints its URL as its first line and ends with its standard input."""

    def __init__(self, program, *options):
        self.process = subprocess.Popen([program, *map(str, options)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        self.port = urlsplit(self.url).port

    def command(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def stop(self):
        """Lets the server drain; its exit code."""
        self.process.stdin.close()
        code = self.process.wait(TIMEOUT_S)
        self.process.stdout.close()
        return code

    def status_field(self, name):
        """A number of /proc/PID/status, such as Threads."""
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as lines:
            return next(int(line.split()[1]) for line in lines if line.startswith(name + ":"))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()


class Reply:
    location = None  # of a redirect, as a path from the root

    def __init__(self, status, headers, body):
        self.status = status
        self.headers = headers
        self.body = body

    def json(self):
        return json.loads(self.body)


class Stream:
    """A socket that is read by lines and counts."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), TIMEOUT_S)
        self.file = self.socket.makefile("rb")

    def send(self, data):
        self.socket.sendall(data)

    def read(self, count):
        data = self.file.read(count)
        if len(data) < count:
            raise EOFError(f"the server ended after {len(data)} of {count} bytes")
        return data

    def read_reply(self, has_body=True):
        """None when the server ended the connection without one."""
        status_line = self.file.readline()
        if not status_line:
            return None
        headers = {}
        while (line := self.file.readline().strip()):
            name, value = line.decode("latin-1").split(":", 1)
            headers[name.lower()] = value.strip()
        status = int(status_line.split()[1])
        length = int(headers.get("content-length", 0))
        body = self.read(length) if has_body and status not in (101, 304) else b""
        return Reply(status, headers, body)

    def close(self):
        self.file.close()
        self.socket.close()


def request_bytes(port, target, method="GET", headers=None):
    lines = {"Host": f"127.0.0.1:{port}", **(headers or {})}
    text = f"{method} {target} HTTP/1.1\r\n"
    text += "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None)
    return (text + "\r\n").encode("latin-1")


def fetch(port, target, method="GET", headers=None):
    stream = Stream(port)
    stream.send(request_bytes(port, target, method, {"Connection": "close", **(headers or {})}))
    reply = stream.read_reply(has_body=method != "HEAD")
    if "location" in reply.headers:
        reply.location = urljoin(target, reply.headers["location"])
    stream.close()
    return reply


class Atlas:
    """One binary message, taken apart."""

    def __init__(self, message):
        (length,) = struct.unpack_from("<I", message)
        self.header = json.loads(message[4:4 + length])
        self.jpeg, rest = self._split(message[4 + length:], self.header["jpeg_bytes"])
        self.depth, rest = self._split(rest, self.header["depth_bytes"])
        assert not rest, f"{len(rest)} bytes too many"

    @staticmethod
    def _split(data, size):
        assert len(data) >= size, f"{size} bytes are said, {len(data)} are there"
        return data[:size], data[size:]


class WebSocket:
    """RFC 6455, client side, as far as the server uses it."""

    CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10

    def __init__(self, port, target, headers=None):
        self.stream = Stream(port)
        self.close_code = None
        key = base64.b64encode(os.urandom(16)).decode()
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": key,
                   "Sec-WebSocket-Version": "13"}
        self.stream.send(request_bytes(port, target, headers={**upgrade, **(headers or {})}))
        self.reply = self.stream.read_reply()
        self.is_open = self.reply is not None and self.reply.status == 101

    def send_frame(self, opcode, payload=b"", is_last=True):
        mask = os.urandom(4)
        size = len(payload)
        if size < 126:
            head = struct.pack("!BB", is_last << 7 | opcode, 0x80 | size)
        else:
            head = struct.pack("!BBH", is_last << 7 | opcode, 0x80 | 126, size)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        self.stream.send(head + mask + masked)

    def send_json(self, value):
        self.send_frame(self.TEXT, json.dumps(value).encode())

    def shown(self, atlas):
        self.send_json({"shown": atlas.header["delivery"]})

    def receive(self):
        """An Atlas, a dict (text message), or None after a close frame. Answers pings."""
        while True:
            first, second = self.stream.read(2)
            opcode, size = first & 15, second & 127
            if size == 126:
                (size,) = struct.unpack("!H", self.stream.read(2))
            elif size == 127:
                (size,) = struct.unpack("!Q", self.stream.read(8))
            payload = self.stream.read(size)
            if opcode == self.PING:
                self.send_frame(self.PONG, payload)
            elif opcode == self.CLOSE:
                (self.close_code,) = struct.unpack("!H", payload[:2])
                # A server that refuses to read on may be gone before it gets the answer.
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                    self.send_frame(self.CLOSE, payload)
                return None
            elif opcode == self.TEXT:
                return json.loads(payload)
            elif opcode == self.BINARY:
                return Atlas(payload)

    def receive_atlas(self):
        received = self.receive()
        assert isinstance(received, Atlas), f"got {received} instead of an atlas"
        return received

    def close(self):
        self.stream.close()


def decode_view(image, layout, view):
    """The number painted into a view's tile of an atlas (a PIL image)."""
    width, height = layout["tile_size"]["width"], layout["tile_size"]["height"]
    column, row = view % layout["columns"], view // layout["columns"]
    left = column * width
    top = layout["padding_top_px"] + (layout["rows"] - 1 - row) * height
    return decode_code(image.crop((left, top, left + width, top + height)))


def decode_code(tile):
    """The number that eight squares in the middle of a tile spell: white is 1, highest first."""
    number = 0
    for bit in range(8):
        x = tile.width * (0.1 + 0.8 * (bit + 0.5) / 8)
        level = tile.convert("L").getpixel((int(x), tile.height // 2))
        assert level < 60 or level > 195, f"square {bit} is neither black nor white: {level}"
        number = number * 2 + (level > 127)
    return number
