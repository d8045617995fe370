# SPDX-License-Identifier: Apache-2.0
"""Who may reach the web server: names, pages of others, more visitors than there is room for."""
import sys
import time
import unittest

from painted_case import PaintedCase
from web_client import Server, Stream, WebSocket, asked, fetch, quilt, request_bytes

PROGRAM = sys.argv.pop(1)
UPGRADE = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
           "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
WATCHING = "/ws?" + asked(quilt(4, 2, 320, 160))


class Visitors(PaintedCase):
    PROGRAM = PROGRAM

    def test_foreign_names_and_pages_are_refused(self):
        cases = (
            ({"Host": "evil.example"}, 403, "host"),
            ({"Host": f"evil.example:{self.port}"}, 403, "host"),
            ({"Host": "127.0.0.1.evil.example"}, 403, "host"),
            ({"Host": ""}, 403, "host"),
            ({"Host": None}, 403, "host"),
            ({"Host": "["}, 403, "host"),
            ({**UPGRADE, "Origin": "http://evil.example"}, 403, "origin"),
            ({**UPGRADE, "Origin": "null"}, 403, "origin"),
            ({**UPGRADE, "Origin": f"http://localhost:{self.port}"}, 403, "origin"),
        )
        for headers, status, field in cases:
            with self.subTest(headers):
                reply = fetch(self.port, "/ws?stream=painted", headers=headers)
                self.assertEqual(reply.status, status)
                self.assertEqual(reply.json()["error"]["field"], field)
        for host in (f"localhost:{self.port}", f"LOCALHOST:{self.port}", "127.0.0.9", "[::1]:80"):
            with self.subTest(host):
                self.assertEqual(fetch(self.port, "/healthz", headers={"Host": host}).status, 200)

    def test_foreign_pages_embed_nothing(self):
        target = "/still/painted_qs4x2a1.jpg?width=320&height=160"
        foreign = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors"}
        self.assertEqual(fetch(self.port, target, headers=foreign).status, 403)
        foreign.update({"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"})
        self.assertEqual(fetch(self.port, target, headers=foreign).status, 403)
        foreign["Sec-Fetch-Dest"] = "document"
        reply = fetch(self.port, target, headers=foreign)
        self.assertEqual(reply.status, 200, reply.body)
        self.assertEqual(reply.headers["cross-origin-resource-policy"], "same-origin")
        self.assertNotIn("access-control-allow-origin", reply.headers)

    def test_allowed_pages_watch_and_embed(self):
        page = "https://show.example"
        with Server(PROGRAM, "--allow-origin", page) as server:
            for headers in ({"Origin": page}, {"Referer": page + "/wall"}):
                headers.update({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors"})
                reply = fetch(server.port, "/api/streams", headers=headers)
                self.assertEqual(reply.status, 200, reply.body)
                self.assertEqual(reply.headers["access-control-allow-origin"], page)
                self.assertEqual(reply.headers["cross-origin-resource-policy"], "cross-origin")
            for origin, is_open in ((page, True), ("https://other.example", False)):
                watcher = WebSocket(server.port, WATCHING,
                                    headers={"Origin": origin})
                self.assertEqual(watcher.is_open, is_open, origin)
                watcher.close()
            self.assertEqual(server.stop(), 0)

    def test_a_new_connection_takes_the_place_of_one_that_waits(self):
        with Server(PROGRAM, "--connections", 3) as server:
            held = [Stream(server.port) for _ in range(3)]
            for stream in held[1:]:  # the first one sends nothing
                stream.send(request_bytes(server.port, "/healthz"))
                self.assertEqual(stream.read_reply().status, 200)
            self.assertEqual(fetch(server.port, "/api/streams").status, 200)
            self.assertEqual(held[0].file.read(), b"")
            held[2].send(request_bytes(server.port, "/api/streams"))
            self.assertEqual(held[2].read_reply().status, 200)
            for stream in held:
                stream.close()
            self.assertEqual(server.stop(), 0)

    def test_health_and_metrics_answer_when_all_connections_watch(self):
        with Server(PROGRAM, "--connections", 3) as server:
            watching = [WebSocket(server.port, WATCHING)
                        for _ in range(3)]
            self.assertTrue(all(watcher.is_open for watcher in watching))
            silent = [Stream(server.port) for _ in range(40)]  # more than are kept
            reply = fetch(server.port, "/api/streams")
            self.assertEqual(reply.status, 503)
            self.assertIn("too many connections", reply.json()["error"]["message"])
            self.assertEqual(fetch(server.port, "/healthz").body, b"serving\n")
            metrics = fetch(server.port, "/metrics").body.decode()
            self.assertIn('viewloom_connections_refused_total{transport="web"}', metrics)
            for stream in silent + watching:
                stream.close()
            self.assertEqual(server.stop(), 0)

    def test_a_flood_of_messages_is_read_slowly(self):
        with Server(PROGRAM) as server:
            watcher = WebSocket(server.port, WATCHING)
            begun = time.monotonic()
            for _ in range(1500):
                watcher.send_json({"nothing": 1})
            watcher.send_json({"ping": 7})
            while watcher.receive() != {"pong": 7}:
                pass
            # 500 a second, and one second's worth at once.
            self.assertGreater(time.monotonic() - begun, 1.5)
            watcher.close()
            self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    unittest.main()
