# SPDX-License-Identifier: Apache-2.0
"""Visits to the web port: the page, pictures and WebSockets, good and bad."""

import contextlib
import http.client
import json
import socket
import urllib.parse

from visits import PATIENCE_S, PLAIN
from web_floods import open_socket, text_frame, upgrade_headers

FOREIGN = "http://evil.example"
WRONG_MESSAGES = (b"{", b'{"change":' + b"[" * 500 + b"]" * 500 + b"}", b'{"unknown": 1}',
                  b'{"change":{"display":{"quilt":{"columns":9999}}}}')
REDIRECT = 302


def get(visit, path, **headers):
    """Status and bytes of an answer."""
    one = http.client.HTTPConnection("localhost", timeout=PATIENCE_S)
    one.sock = visit.place.web()
    try:
        shown = {"Host": f"localhost:{visit.place.address.http_port}",
                 **dict(visit.place.metadata), **headers}
        one.request("GET", path, headers=shown)
        answer = one.getresponse()
        if answer.status == REDIRECT:
            return answer.status, answer.headers["Location"].encode()
        return answer.status, answer.read()
    finally:
        one.close()


def final(visit, path):
    """Where a picture really is: a quilt has its layout in its name."""
    status, place = get(visit, path)
    return urllib.parse.urljoin(path, place.decode()) if status == REDIRECT else path


def expect(path, status, wanted):
    if status != wanted:
        raise RuntimeError(f"{path[:60]} answered {status} instead of {wanted}")


def query(display, **more):
    return urllib.parse.urlencode({"display": json.dumps(display), **more})


def bearer(visit):
    """The header by which a WebSocket shows its token."""
    if not visit.place.token:
        return {}
    return {"Sec-WebSocket-Protocol": f"viewloom, bearer.{visit.place.token}"}


def read_page(visit):
    for path in ("/", "/api/streams", "/api/displays", "/api/presets", "/healthz"):
        expect(path, get(visit, path)[0], 200)
    expect("/nowhere", get(visit, "/nowhere")[0], 404)


def see_still(visit):
    """A picture, and one by a signed link where there are tokens."""
    with visit.publishing():
        path = final(visit, f"/still/{visit.stream}.jpg?{query(PLAIN)}")
        expect(path, get(visit, path)[0], 200)
        if visit.place.token:
            link = f"/api/link?target={urllib.parse.quote(path, safe='')}"
            status, text = get(visit, link)
            expect(link, status, 200)
            linked = urllib.parse.urlsplit(json.loads(text)["url"])
            target = urllib.parse.urlunsplit(("", "", linked.path, linked.query, ""))
            expect(target, get(visit, target, authorization="")[0], 200)


def play_stream(visit):
    """Motion JPEG that breaks off."""
    with visit.publishing(), visit.place.web() as one:
        path = final(visit, f"/stream/{visit.stream}.mjpg?{query(PLAIN)}")
        lines = {"Host": f"localhost:{visit.place.address.http_port}",
                 **dict(visit.place.metadata)}
        one.sendall((f"GET {path} HTTP/1.1\r\n" +
                     "".join(f"{name}: {value}\r\n" for name, value in lines.items()) +
                     "\r\n").encode())
        answer = one.recv(4096)
        if b" 200 " not in answer:
            raise RuntimeError(f"motion JPEG was refused: {answer[:200]}")
        one.recv(65536)


@contextlib.contextmanager
def viewing(visit):
    """A WebSocket that shows the stream."""
    one = open_socket(visit.place.address, f"/ws?{query(PLAIN, stream=visit.stream)}",
                      **bearer(visit))
    if one is None:
        raise RuntimeError("the WebSocket was refused")
    with one:
        one.settimeout(PATIENCE_S)
        yield one


def view_and_change(visit):
    """Pictures that are shown, then of another display."""
    change = {"change": {"display": {"quilt": {"columns": 2, "rows": 1, "size":
                                               {"width": 120, "height": 60}}}}}
    with visit.publishing(), viewing(visit) as one:
        one.recv(65536)
        one.sendall(text_frame(b'{"shown": 1}') + text_frame(json.dumps(change).encode()) +
                    text_frame(b'{"ping": 1}'))
        one.recv(65536)


def view_and_send_nonsense(visit):
    with visit.publishing(), viewing(visit) as one:
        one.recv(65536)
        one.sendall(text_frame(visit.random.choice(WRONG_MESSAGES)))
        one.settimeout(0.2)
        with contextlib.suppress(socket.timeout, OSError):
            while one.recv(65536):
                pass


def view_and_never_read(visit):
    with visit.publishing(), viewing(visit):
        pass


def half_request(visit):
    with visit.place.web() as one:
        one.sendall(b"GET /api/streams HTTP/1.1\r\nHost: localhost\r\nX-A: ")


def foreign_page(visit):
    """A page of others that wants to watch."""
    headers = upgrade_headers(Origin=FOREIGN, **bearer(visit))
    expect("/ws of a foreign page",
           get(visit, f"/ws?{query(PLAIN, stream=visit.stream)}", **headers)[0], 403)


PAGES = (read_page, see_still, play_stream, view_and_change, view_and_send_nonsense,
         view_and_never_read, half_request, foreign_page)
