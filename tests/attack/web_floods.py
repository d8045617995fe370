# SPDX-License-Identifier: Apache-2.0
"""Pages of others, and messages of WebSockets."""

import base64
import contextlib
import http.client
import os
import socket
import struct
import urllib.parse

SOCKET_TARGET = "/ws?" + urllib.parse.urlencode({"stream": "healthy", "preset": "portrait",
                                                 "width": 84, "height": 112})
UPGRADE = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}


def status_of(address, path, headers):
    connection = http.client.HTTPConnection("127.0.0.1", address.http_port, timeout=5)
    try:
        connection.request("GET", path, headers=headers)
        return connection.getresponse().status
    finally:
        connection.close()


def upgrade_headers(**more):
    key = base64.b64encode(os.urandom(16)).decode()
    return {**UPGRADE, "Sec-WebSocket-Key": key, **more}


def dns_rebinding(address, _budget):
    """Requests as browsers send them for a page whose name leads to this server."""
    found = []
    for host in ("evil.example", f"evil.example:{address.http_port}", "127.0.0.1.evil.example"):
        for path, headers in (("/api/streams", {}), ("/", {}), ("/still/healthy/portrait", {}),
                              (SOCKET_TARGET, upgrade_headers(Origin=f"http://{host}"))):
            status = status_of(address, path, {"Host": host, **headers})
            if status not in (403, 421):
                found.append(f"{path[:20]} for {host}: {status} instead of 403")
    foreign = upgrade_headers(Origin="http://evil.example")
    status = status_of(address, SOCKET_TARGET, foreign)
    if status != 403:
        found.append(f"a WebSocket of a foreign page: {status} instead of 403")
    embedded = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors"}
    status = status_of(address, "/still/healthy/portrait", embedded)
    if status != 403:
        found.append(f"a still inside a foreign page: {status} instead of 403")
    framed = {**embedded, "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"}
    status = status_of(address, "/still/healthy/portrait", framed)
    if status != 403:
        found.append(f"a still in a frame of a foreign page: {status} instead of 403")
    return found


def text_frame(text):
    """A masked text frame of a client (RFC 6455); the mask is zero."""
    size = len(text)
    head = struct.pack("!BB", 0x81, 0x80 | size) if size < 126 else (
        struct.pack("!BBH", 0x81, 0xfe, size) if size < 65536 else
        struct.pack("!BBQ", 0x81, 0xff, size))
    return head + bytes(4) + text


def open_socket(address, socket_target=SOCKET_TARGET, **headers):
    """A WebSocket whose server need not be read, or None."""
    one = address.connect(address.http_port, ("http/1.1",))
    lines = {"Host": f"127.0.0.1:{address.http_port}", **upgrade_headers(**headers)}
    request = f"GET {socket_target} HTTP/1.1\r\n"
    request += "".join(f"{name}: {value}\r\n" for name, value in lines.items())
    one.sendall((request + "\r\n").encode())
    if b" 101 " in one.recv(1024):
        one.settimeout(0.05)
        return one
    one.close()
    return None


def flood_with(address, budget, message, most):
    """Sends a message again and again, and reads what comes."""
    is_over = budget.deadline()
    one = open_socket(address)
    if one is None:
        return ["the WebSocket was refused"]
    frames = text_frame(message) * max(1, 4096 // len(message))
    left = most
    with one:
        while left > 0 and not is_over():
            left -= len(frames)
            with contextlib.suppress(socket.timeout):
                one.sendall(frames)
            with contextlib.suppress(socket.timeout):
                if not one.recv(1 << 16):
                    break
    return []


def broken_json(address, budget):
    """Small messages that are no JSON."""
    return flood_with(address, budget, b"{", budget.count(4 << 20, 64 << 20))


def deep_json(address, budget):
    """Messages that nest lists, as long as they may be."""
    message = b'{"change":' + b"[" * 60_000 + b"]" * 60_000 + b"}"
    return flood_with(address, budget, message, budget.count(16 << 20, 256 << 20))


def deep_calibration(address, budget):
    """Calibrations that nest lists."""
    deep = "[" * 15_000 + "]" * 15_000
    message = ('{"change":{"display":{"lenticular":{"calibrationJson":"{\\"pitch\\":' + deep +
               '}"}}}}').encode()
    return flood_with(address, budget, message, budget.count(2 << 20, 64 << 20))


ATTACKS = (dns_rebinding, broken_json, deep_json, deep_calibration)
