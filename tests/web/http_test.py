# SPDX-License-Identifier: Apache-2.0
"""The web server as a stranger sees it: pages, catalogue, and what nobody should send."""
import json
import socket
import sys
import unittest
from urllib.parse import quote

from painted_case import PaintedCase
from web_client import Server, Stream, fetch, quilt, request_bytes

PROGRAM = sys.argv.pop(1)


class Answers(PaintedCase):
    PROGRAM = PROGRAM

    def by_name(self, what):
        return {entry["name"]: entry for entry in fetch(self.port, f"/api/{what}").json()[what]}

    def test_serves_every_file_the_page_names(self):
        page = fetch(self.port, "/")
        self.assertEqual(page.status, 200)
        self.assertEqual(page.headers["content-type"], "text/html; charset=utf-8")
        for path, kind in (("/style.css", "text/css"), ("/page.js", "text/javascript"),
                           ("/icon.svg", "image/svg+xml")):
            # Relative: a proxy may serve the page below a path.
            self.assertIn(f'"{path[1:]}"', page.body.decode())
            reply = fetch(self.port, path)
            self.assertEqual(reply.status, 200, path)
            self.assertTrue(reply.headers["content-type"].startswith(kind), path)
            self.assertEqual(reply.headers["x-content-type-options"], "nosniff")
        for line in fetch(self.port, "/page.js").body.decode().splitlines():
            if line.startswith("import"):
                module = line.split("'./")[1].split("'")[0]
                self.assertEqual(fetch(self.port, "/" + module).status, 200, module)

    def test_names_nothing_outside_itself_but_a_bridge_on_the_same_machine(self):
        policy = fetch(self.port, "/").headers["content-security-policy"]
        self.assertIn("connect-src 'self' http://localhost:33334;", policy)
        policy = policy.replace("http://localhost:33334", "")
        self.assertIn("default-src 'none'", policy)
        for word in ("http", "unsafe", "*"):
            self.assertNotIn(word, policy)

    def test_answers_not_modified_to_who_has_the_file(self):
        etag = fetch(self.port, "/style.css").headers["etag"]
        reply = fetch(self.port, "/style.css", headers={"If-None-Match": etag})
        self.assertEqual(reply.status, 304)
        self.assertEqual(fetch(self.port, "/style.css",
                               headers={"If-None-Match": '"other"'}).status, 200)

    def test_sends_no_body_to_head(self):
        stream = Stream(self.port)
        stream.send(request_bytes(self.port, "/style.css", "HEAD") +
                    request_bytes(self.port, "/healthz"))
        self.assertGreater(int(stream.read_reply(has_body=False).headers["content-length"]), 0)
        self.assertEqual(stream.read_reply().body, b"serving\n")
        stream.close()

    def test_lists_streams_displays_and_presets(self):
        streams = self.by_name("streams")
        self.assertEqual(sorted(streams), ["painted", "silent"])
        self.assertTrue(streams["painted"]["live"])
        self.assertEqual(streams["painted"]["size"], {"width": 1280, "height": 720})
        presets = self.by_name("presets")
        self.assertEqual(presets["portrait"]["kinds"], ["quilt", "lenticular"])
        self.assertEqual(presets["portrait"]["layout"]["columns"], 8)
        self.assertEqual(presets["portrait"]["layout"]["size"], {"width": 3360, "height": 3360})
        self.assertEqual(presets["near_eye_2013"]["kinds"], ["integral"])
        self.assertNotIn("layout", presets["wowvx"], "its size is the client's to say")

    def test_tells_the_range_of_each_number_of_a_display(self):
        fields = fetch(self.port, "/api/fields").json()["fields"]
        self.assertEqual(fields["quilt.columns"], {"min": 1, "max": 50})
        self.assertEqual(fields["filter.sample_count"], {"min": 1, "max": 16})
        self.assertIn("cameras.grid.spacing_x_m", fields)
        self.assertEqual(fetch(self.port, "/api/displays").json(), {"displays": []})

    def test_shows_prometheus_what_it_did(self):
        fetch(self.port, "/nowhere")
        reply = fetch(self.port, "/metrics")
        self.assertTrue(reply.headers["content-type"].startswith("text/plain; version=0.0.4"))
        samples = dict(line.rsplit(" ", 1) for line in reply.body.decode().splitlines()
                       if not line.startswith("#"))
        self.assertEqual(float(samples["viewloom_streams_live"]), 2)
        self.assertGreaterEqual(
            float(samples['viewloom_http_responses_total{answer="client_error"}']), 1)

    def test_closes_a_connection_that_says_nothing(self):
        stream = Stream(self.port)
        stream.send(b"GET / HT")
        self.assertEqual(stream.file.read(), b"")
        stream.close()


class Refusals(PaintedCase):
    """Each request that nobody should send, with the status and the field it is refused for."""

    PROGRAM = PROGRAM
    TARGETS = (
        ("/nowhere", 404, "url"),
        ("/../etc/passwd", 404, "url"),
        ("/%2e%2e/etc/passwd", 404, "url"),
        ("/%", 400, "url"),
        ("/%4", 400, "url"),
        ("/%zz", 400, "url"),
        ("/%00", 400, "url"),
        ("/?a=%0d%0aSet-Cookie:b", 400, "url"),
        ("http://127.0.0.1/", 400, "url"),
        ("*", 400, "url"),
        ("/ws", 400, "stream"),
        ("/ws?stream=none", 404, "stream"),
        ("/ws?stream=painted", 426, ""),
        ("/ws?stream=painted&stream=painted", 400, "stream"),
        ("/ws?stream=painted&colour=red", 400, "colour"),
        ("/ws?stream=painted&preset=none", 404, "preset"),
        ("/ws?stream=painted&width=99999999&height=1", 400, "width"),
        ("/ws?stream=painted&width=3&height=3000", 400, "width"),
        ("/ws?stream=painted&width=4x", 400, "width"),
        ("/ws?stream=painted&preset=portrait&display=%7B%7D", 400, "preset"),
        *((f"/ws?stream=painted&display={quote(text)}", 400, field) for text, field in (
            ("", "display"), ("{", "display"), ("[]", "display"), ("5", "display"),
            ("{}", "display.kind"), ('{"quilt": 5}', "display.quilt"),
            ('{"quilt": {}, "stereo": {}}', "display"),
            ("[" * 2000, "display"), ('{"quilt":' * 200, "display.quilt.quilt"),
            ('{"quilt": {"columns": 8, "columns": 8}}', "display.quilt.columns"),
            ('{"quilt": {"colums": 8}}', "display.quilt.colums"))),
        *((f"/ws?stream=painted&display={quote(json.dumps(display))}", 400, "display." + field)
          for display, field in (
              (quilt(0, 2, 9, 9), "quilt.columns"), (quilt(51, 2, 99, 99), "quilt.columns"),
              (quilt(-1, 2, 9, 9), "quilt.columns"), (quilt(2**32 + 1, 2, 9, 9), "quilt.columns"),
              (quilt("4x", 2, 9, 9), "quilt.columns"), (quilt("", 2, 9, 9), "quilt.columns"),
              (quilt(4, 2, 9, 9, aspect="NaN"), "quilt.aspect"),
              (quilt(4, 2, 9, 9, aspect=1e9), "quilt.aspect"),
              (quilt(4, 2, 9, 9, view_cone_rad=-1), "quilt.view_cone_rad"),
              (quilt(4, 2, 9, 9, view_cone_rad="Infinity"), "quilt.view_cone_rad"),
              (quilt(4, 2, 9, 9, view_cone_rad=6), "quilt.view_cone_rad"),
              (quilt(4, 2, 9, 9, focal_distance_m=-1), "quilt.focal_distance_m"),
              (quilt(4, 2, 9, 9, fov_y_rad=3.2), "quilt.fov_y_rad"),
              (quilt(4, 2, 9, 9, order="TOP"), "quilt.order"))),
        *((f"/ws?stream=painted&encoding={quote(json.dumps(encoding))}", 400, "encoding." + field)
          for encoding, field in (
              ({"jpeg_quality": 101}, "jpeg_quality"), ({"jpeg_quality": 0.5}, "jpeg_quality"),
              ({"chroma": "CHROMA_SUBSAMPLING_422"}, "chroma"),
              ({"color": "BAND_ENCODING_ZSTD"}, "color"))),
        ("/still/", 404, "url"),
        ("/still/painted", 404, "url"),
        ("/still/painted.png", 404, "url"),
        ("/still/painted/", 404, "preset"),
        ("/still/painted/none", 404, "preset"),
        ("/still/none/portrait", 404, "stream"),
        ("/still/painted_qsax.jpg", 404, "url"),
        ("/still/painted_qs0x0a0.jpg", 400, "display.quilt.columns"),
        ("/still/painted_qs4x2a1.jpg", 400, "display.quilt.size"),
        ("/still/" + "a/" * 2000, 404, "preset"),
    )

    def test_targets(self):
        for target, status, field in self.TARGETS:
            with self.subTest(target[:60]):
                reply = fetch(self.port, target)
                self.assertEqual(reply.status, status, reply.body)
                self.assertEqual(reply.json()["error"]["field"], field)
                self.assertTrue(reply.json()["error"]["message"])

    def test_a_misspelt_name_gets_the_nearest_ones(self):
        for target, name in (("/ws?stream=paintde", "painted"), ("/ws?stream=Painted", "painted"),
                             ("/ws?stream=painted&preset=portait", "portrait"),
                             ("/ws?stream=painted&preset=wovwx", "wowvx"),
                             ("/ws?stream=painted&dispaly=4", "display"),
                             ('/ws?stream=painted&display={"quilt":{"colums":4}}', "columns"),
                             ('/ws?stream=painted&display={"rgbd":{"nearM":1,"near":1}}', "near_m"),
                             ("/still/paintd/portrait", "painted"),
                             ("/still/painted/portait.json", "portrait"),
                             ("/stream/painted/portrat", "portrait"),
                             ("/still/painted/near_eye_213", "near_eye_2013"),
                             ('/ws?stream=painted&display={"rgbd":{"preset":"wowx"}}', "wowvx"),
                             ("/api/stream", "/api/streams"), ("/metric", "/metrics")):
            with self.subTest(target):
                message = fetch(self.port, target).json()["error"]["message"]
                self.assertIn(f'did you mean "{name}"', message)
        message = fetch(self.port, "/ws?stream=entirely-other").json()["error"]["message"]
        self.assertNotIn("did you mean", message)

    def test_upgrades_are_refused_like_requests(self):
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                   "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
        for target, status in (("/ws?stream=none", 404), ("/ws?stream=painted&width=x", 400),
                               ("/other", 404)):
            with self.subTest(target):
                self.assertEqual(fetch(self.port, target, headers=upgrade).status, status)

    def test_bytes_that_are_no_request(self):
        host = f"Host: 127.0.0.1:{self.port}\r\n"
        cases = (
            ("POST", f"POST /ws HTTP/1.1\r\n{host}Content-Length: 0\r\n\r\n", 405),
            ("a body", f"GET / HTTP/1.1\r\n{host}Content-Length: 5\r\n\r\nhello", 413),
            ("a huge body", f"PUT / HTTP/1.1\r\n{host}Content-Length: 99999999999\r\n\r\n", 413),
            ("a negative length", f"GET / HTTP/1.1\r\n{host}Content-Length: -1\r\n\r\n", 400),
            ("two lengths",
             f"GET / HTTP/1.1\r\n{host}Content-Length: 0\r\nContent-Length: 5\r\n\r\n", 400),
            ("a long header", f"GET / HTTP/1.1\r\n{host}X: {'x' * 9000}\r\n\r\n", 431),
            ("a long target", f"GET /{'x' * 9000} HTTP/1.1\r\n{host}\r\n", 431),
            ("no HTTP", "\x16\x03\x01\x02\x00\x01\x00\r\n\r\n", 400),
            ("a strange version", f"GET / HTTP/7.5\r\n{host}\r\n", 400),
        )
        for name, text, status in cases:
            with self.subTest(name):
                stream = Stream(self.port)
                stream.send(text.encode("latin-1"))
                reply = stream.read_reply()
                self.assertEqual(reply.status, status)
                self.assertTrue(json.loads(reply.body)["error"]["message"])
                stream.close()
        self.assertEqual(fetch(self.port, "/healthz").status, 200)

    def test_drains_with_idle_connections_open(self):
        with Server(PROGRAM) as server:
            idle = Stream(server.port)
            idle.send(request_bytes(server.port, "/healthz"))
            self.assertEqual(idle.read_reply().status, 200)
            self.assertEqual(server.stop(), 0)
            self.assertEqual(idle.file.read(), b"")
            idle.close()
            with self.assertRaises(ConnectionRefusedError):
                socket.create_connection(("127.0.0.1", server.port))


if __name__ == "__main__":
    unittest.main()
