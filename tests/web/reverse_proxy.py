# SPDX-License-Identifier: Apache-2.0
"""A reverse proxy that serves another server below a path, as nginx and HAProxy do, and passes
`Host` on unchanged."""
import re
import select
import socket
import socketserver
import threading

READ_BYTES = 1 << 16
HEAD_BYTES_MAX = 1 << 16


def read_head(connection):
    """A request's head and the bytes behind it; (None, None) if none came."""
    data = b""
    while b"\r\n\r\n" not in data:
        part = connection.recv(READ_BYTES)
        if not part or len(data) > HEAD_BYTES_MAX:
            return None, None
        data += part
    head, rest = data.split(b"\r\n\r\n", 1)
    return head.decode("latin-1"), rest


def pass_on(one, other):
    """Copies both ways until one side ends."""
    while True:
        for source in select.select([one, other], [], [])[0]:
            data = source.recv(READ_BYTES)
            if not data:
                return
            (other if source is one else one).sendall(data)


class Handler(socketserver.BaseRequestHandler):
    """One request a connection, or one WebSocket."""

    def handle(self):
        head, rest = read_head(self.request)
        if head is None:
            return
        method, target, _ = head.split(" ", 2)
        if (answer := self.server.instead(method, target)) is not None:
            self.request.sendall(answer)
            return
        lines = head.split("\r\n")
        lines[0] = lines[0].replace(self.server.prefix, "", 1)
        if not re.search(r"^upgrade:", head, re.I | re.M):
            lines = [line for line in lines if not line.lower().startswith("connection:")]
            lines.append("Connection: close")
        with socket.create_connection(("127.0.0.1", self.server.port_behind)) as behind:
            try:
                behind.sendall("\r\n".join(lines).encode("latin-1") + b"\r\n\r\n" + rest)
                pass_on(self.request, behind)
            except ConnectionError:
                pass  # either side may go


class ReverseProxy(socketserver.ThreadingTCPServer):
    """prefix: such as "/light/field"; port_behind: of the server, on this machine. `targets` are
    those that were asked for."""

    allow_reuse_address = True
    daemon_threads = True

    def __init__(self, port_behind, prefix, port=0):
        super().__init__(("127.0.0.1", port), Handler)
        self.port_behind = port_behind
        self.prefix = prefix
        self.targets = []
        threading.Thread(target=self.serve_forever, daemon=True).start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_address[1]}{self.prefix}/"

    def instead(self, _method, target):
        """An answer of the proxy's own: of all that is not below its path."""
        self.targets.append(target)
        if target.startswith(self.prefix + "/"):
            return None
        return b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"

    def stop(self):
        self.shutdown()
        self.server_close()
