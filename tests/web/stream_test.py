# SPDX-License-Identifier: Apache-2.0
"""Motion JPEG, taken apart by a client that shares no code with the server."""
import io
import os
import socket
import sys
import time
import unittest

from PIL import Image

from web_client import TIMEOUT_S, Server, Stream, decode_view, fetch, request_bytes

PROGRAM = sys.argv.pop(1)
SMALL = "/stream/painted_qs4x2a1.mjpg?width=320&height=160"
# Atlases of 0.4 MB: twenty are more than the sockets of a player hold.
LARGE = "/stream/painted_qs8x6a1.mjpg?width=3200&height=2400&quality=100&chroma=444"
BOUNDARY = b"--viewloom\r\n"


class Part:
    def __init__(self, headers, jpeg):
        self.sequence = int(headers["viewloom-sequence"])
        self.type = headers["content-type"]
        self.jpeg = jpeg

    def image(self):
        image = Image.open(io.BytesIO(self.jpeg))
        image.load()  # every byte of it
        return image


class Player(Stream):
    """Reads parts; the boundary before each comes with the one before it."""

    def __init__(self, port, target, method="GET", receive_bytes=None):
        if receive_bytes is None:
            super().__init__(port)
        else:
            self.socket = socket.socket()
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
            self.socket.settimeout(TIMEOUT_S)
            self.socket.connect(("127.0.0.1", port))
            self.file = self.socket.makefile("rb")
        self.send(request_bytes(port, target, method))
        self.reply = self.read_reply()
        if self.reply.status == 200 and method == "GET":
            assert self.read(len(BOUNDARY)) == BOUNDARY

    def next_part(self):
        """None where the server ended the stream in good order."""
        line = self.file.readline()
        if line == b"\r\n":
            assert self.file.read() == b"--viewloom--\r\n"
            return None
        headers = {}
        while line.strip():
            name, value = line.decode("ascii").split(":", 1)
            headers[name.lower()] = value.strip()
            line = self.file.readline()
        jpeg = self.read(int(headers["content-length"]))
        assert self.read(2 + len(BOUNDARY)) == b"\r\n" + BOUNDARY
        return Part(headers, jpeg)


class Streams(unittest.TestCase):
    def setUp(self):
        self.server = Server(PROGRAM)
        self.addCleanup(self.server.__exit__)

    def play(self, target=SMALL, **options):
        player = Player(self.server.port, target, **options)
        self.addCleanup(player.close)
        self.assertEqual(player.reply.status, 200, player.reply.body)
        return player

    def displays(self):
        return fetch(self.server.port, "/api/displays").json()["displays"]

    def wait_for_no_display(self):
        deadline = time.monotonic() + TIMEOUT_S
        while self.displays():
            self.assertLess(time.monotonic(), deadline, "the display stays")
            time.sleep(0.01)

    def test_each_part_is_one_whole_jpeg_of_the_next_atlas(self):
        player = self.play()
        self.assertEqual(player.reply.headers["content-type"],
                         "multipart/x-mixed-replace; boundary=viewloom")
        self.assertEqual(player.reply.headers["connection"], "close")
        layout = {"columns": 4, "rows": 2, "padding_top_px": 0,
                  "tile_size": {"width": 80, "height": 80}}
        for expected in range(1, 8):
            part = player.next_part()
            self.assertEqual((part.sequence, part.type), (expected, "image/jpeg"))
            image = part.image()
            self.assertEqual(image.size, (320, 160))
            self.assertEqual([decode_view(image, layout, view) for view in range(8)],
                             list(range(8)))
            self.server.command("frame")

    def test_a_part_ends_before_the_next_one_comes(self):
        self.play().next_part()  # reads the boundary behind it; no second atlas is made

    def test_all_who_play_one_display_are_sent_the_same_bytes(self):
        players = [self.play() for _ in range(3)]
        still = fetch(self.server.port, SMALL.replace("stream", "still").replace("mjpg", "jpg"))
        for player in players:
            self.assertEqual(player.next_part().jpeg, still.body)
        self.server.command("frame")
        first, second, third = (player.next_part().jpeg for player in players)
        self.assertEqual(first, second)
        self.assertEqual(first, third)
        (display,) = self.displays()
        self.assertEqual((display["subscriber_count"], display["atlas_count"]), (3, 2))

    def test_one_who_does_not_read_costs_nobody_anything_and_skips(self):
        deaf = self.play(LARGE, receive_bytes=4096)
        fast = self.play(LARGE)
        size_bytes = len(fast.next_part().jpeg)
        before_kib = None
        for expected in range(2, 42):
            self.server.command("frame")
            self.assertEqual(fast.next_part().sequence, expected)
            if expected == 22:
                before_kib = self.server.status_field("VmRSS")
        if not os.environ.get("VIEWLOOM_SANITIZE"):
            grown_bytes = 1024 * (self.server.status_field("VmRSS") - before_kib)
            self.assertLess(grown_bytes, 6 * size_bytes, "twenty atlases were kept for the deaf")
        sequences = [deaf.next_part().sequence]
        while sequences[-1] < 41:
            part = deaf.next_part()
            part.image()
            sequences.append(part.sequence)
        self.assertEqual(sequences, sorted(set(sequences)))
        self.assertLess(len(sequences), 41, "the deaf got every atlas")

    def test_a_player_that_goes_leaves_its_display_though_nothing_moves(self):
        player = self.play()
        player.next_part()
        self.assertEqual(len(self.displays()), 1)
        player.close()
        self.wait_for_no_display()

    def test_what_a_player_sends_is_ignored(self):
        player = self.play()
        player.next_part()
        player.send(b"x" * 100_000)
        self.server.command("frame")
        self.assertEqual(player.next_part().sequence, 2)

    def test_a_draining_server_ends_between_two_parts(self):
        players = [self.play() for _ in range(3)]
        deaf = self.play(LARGE, receive_bytes=4096)
        for player in players:
            player.next_part()
        self.server.process.stdin.close()
        for player in players:
            self.assertIsNone(player.next_part())
        self.assertEqual(self.server.process.wait(TIMEOUT_S), 0)
        self.assertEqual(deaf.reply.status, 200)

    def test_a_display_that_cannot_be_served_ends(self):
        player = self.play()
        player.next_part()
        self.server.command("refuse")
        self.assertIsNone(player.next_part())

    def test_head_tells_the_type_and_watches_nothing(self):
        player = self.play(method="HEAD")
        self.assertIn("multipart", player.reply.headers["content-type"])
        self.assertEqual(self.displays(), [])
        player.send(request_bytes(self.server.port, "/healthz"))
        self.assertEqual(player.read_reply().body, b"serving\n")

    def test_players_are_counted_among_the_displays_allowed(self):
        for index in range(64):
            self.play(f"{SMALL}&focus_m={index + 1}").next_part()
        refused = Player(self.server.port, f"{SMALL}&focus_m=65")
        self.addCleanup(refused.close)
        self.assertEqual(refused.reply.status, 503)
        self.assertIn("too many distinct displays", refused.reply.json()["error"]["message"])
        refused.send(request_bytes(self.server.port, "/healthz"))
        self.assertEqual(refused.read_reply().status, 200)

    def test_redirects_to_the_url_whose_suffix_says_how_views_lie(self):
        for target in ("/stream/painted/portrait",
                       "/stream/painted_qs5x9a1.6.mjpg?preset=portrait"):
            reply = fetch(self.server.port, target)
            self.assertEqual((reply.status, reply.headers["location"]),
                             (302, "/stream/painted_qs8x6a0.75.mjpg?preset=portrait"))

    def test_targets_that_name_no_stream(self):
        for target, status, field in (("/stream/painted", 404, "url"),
                                      ("/stream/painted_qs4x2a1.jpg", 404, "url"),
                                      ("/stream/none/portrait", 404, "stream"),
                                      ("/stream/painted/none", 404, "preset"),
                                      ("/stream/painted_qs0x0a0.mjpg", 400, "columns")):
            with self.subTest(target):
                reply = fetch(self.server.port, target)
                self.assertEqual((reply.status, reply.json()["error"]["field"]), (status, field))

    @unittest.skipIf(os.environ.get("VIEWLOOM_SANITIZE"), "sanitizers keep what was freed")
    def test_memory_stays_while_players_come_and_go(self):
        def come_and_go():
            for _ in range(100):
                player = Player(self.server.port, SMALL)
                player.next_part()
                player.close()
        come_and_go()
        before_kib = self.server.status_field("VmRSS")
        come_and_go()
        # 100 players that each left their 30 KiB atlas or their coroutines behind would show.
        self.assertLess(self.server.status_field("VmRSS") - before_kib, 2000)
        self.wait_for_no_display()


if __name__ == "__main__":
    unittest.main()
