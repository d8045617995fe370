# SPDX-License-Identifier: Apache-2.0
"""Motion JPEG, taken apart by a client that shares no code with the server."""
import io
import os
import socket
import sys
import time
import unittest

from PIL import Image

from web_client import (TIMEOUT_S, Server, Stream, asked, decode_view, fetch, quilt,
                        request_bytes)

PROGRAM = sys.argv.pop(1)
SMALL = "/stream/painted_qs4x2a1.mjpg?width=320&height=160"
# Atlases of 0.4 MB: twenty are more than the sockets of a player hold.
LARGE = "/stream/painted_qs8x6a1.mjpg?" + asked(
    quilt(8, 6, 3200, 2400, aspect=1),
    {"jpeg_quality": 100, "chroma": "CHROMA_SUBSAMPLING_444"}, stream=None)
STILL = SMALL.replace("stream", "still").replace("mjpg", "jpg")
OPENING = b"--viewloom\r\nContent-Type: image/jpeg\r\n\r\n"
CLOSING = b"--viewloom--\r\n"


class Player(Stream):
    """Reads parts; the header of each comes with the one before it."""

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
        self.buffer = b""
        self.jpeg = None  # of the newest part
        self.has_ended = False
        if self.reply.status == 200 and method == "GET":
            assert self.read(len(OPENING)) == OPENING

    def next_part(self):
        """The next JPEG; None behind the last one, where the server ended in good order."""
        if self.has_ended:
            assert self.buffer + self.file.read() == b""
            return None
        while (found := self.buffer.find(b"\r\n--viewloom")) < 0:
            self._receive()
        self.jpeg, self.buffer = self.buffer[:found], self.buffer[found + 2:]
        while len(self.buffer) < len(CLOSING):
            self._receive()
        self.has_ended = self.buffer.startswith(CLOSING)
        marker = CLOSING if self.has_ended else OPENING
        while len(self.buffer) < len(marker):
            self._receive()
        assert self.buffer.startswith(marker), self.buffer[:99]
        self.buffer = self.buffer[len(marker):]
        return self.jpeg

    def next_picture(self):
        """Another JPEG than the newest; None at the end."""
        before = self.jpeg
        while (jpeg := self.next_part()) == before:
            pass
        return jpeg

    def _receive(self):
        data = self.file.read1(1 << 16)
        if not data:
            raise EOFError("the server ended within a part")
        self.buffer += data


def load(jpeg):
    image = Image.open(io.BytesIO(jpeg))
    image.load()  # every byte of it
    return image


def painted_frame(jpeg):
    """The frame whose bar is at the top of a tile of LARGE, decoded at a quarter of its size."""
    image = Image.open(io.BytesIO(jpeg))
    image.draft("L", (800, 600))
    row = image.crop((0, 2, 100, 3)).tobytes()
    white = [x for x, level in enumerate(row) if level > 240]
    return round((white[0] + white[-1] + 1) / 2 / 100 * 50)


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
            jpeg = player.next_picture()
            still = fetch(self.server.port, STILL)
            self.assertEqual((int(still.headers["viewloom-sequence"]), still.body),
                             (expected, jpeg))
            image = load(jpeg)
            self.assertEqual(image.size, (320, 160))
            self.assertEqual([decode_view(image, layout, view) for view in range(8)],
                             list(range(8)))
            self.server.command("frame")

    def test_the_next_part_is_opened_before_it_is_there(self):
        self.play().next_part()  # reads the header of the next; no second atlas is made

    def test_a_picture_that_stands_is_repeated_once_and_then_seldom(self):
        player = self.play()
        first = player.next_part()
        self.assertEqual(player.next_part(), first)
        player.socket.settimeout(1)
        with self.assertRaises(TimeoutError):
            player.next_part()
        self.assertEqual(len(self.displays()), 1)

    def test_all_who_play_one_display_are_sent_the_same_bytes(self):
        players = [self.play() for _ in range(3)]
        still = fetch(self.server.port, STILL)
        for player in players:
            self.assertEqual(player.next_part(), still.body)
        self.server.command("frame")
        first, second, third = (player.next_picture() for player in players)
        self.assertEqual(first, second)
        self.assertEqual(first, third)
        (display,) = self.displays()
        self.assertEqual((display["subscriber_count"], display["atlas_count"]), (3, 2))

    def test_one_who_does_not_read_costs_nobody_anything_and_skips(self):
        deaf = self.play(LARGE, receive_bytes=4096)
        fast = self.play(LARGE)
        size_bytes = len(fast.next_part())
        before_kib = None
        for expected in range(2, 42):
            self.server.command("frame")
            self.assertEqual(painted_frame(fast.next_picture()), expected)
            if expected == 22:
                before_kib = self.server.status_field("VmRSS")
        if not os.environ.get("VIEWLOOM_SANITIZE"):
            grown_bytes = 1024 * (self.server.status_field("VmRSS") - before_kib)
            self.assertLess(grown_bytes, 6 * size_bytes, "twenty atlases were kept for the deaf")
        frames = [painted_frame(deaf.next_part())]
        while frames[-1] < 41:
            frames.append(painted_frame(deaf.next_picture()))
        self.assertEqual(frames, sorted(set(frames)))
        self.assertLess(len(frames), 41, "the deaf got every atlas")

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
        self.assertEqual(player.next_picture(), fetch(self.server.port, STILL).body)

    def test_a_draining_server_ends_between_two_parts(self):
        players = [self.play() for _ in range(3)]
        deaf = self.play(LARGE, receive_bytes=4096)
        for player in players:
            player.next_part()
        self.server.process.stdin.close()
        for player in players:
            self.assert_ends_with_its_picture(player)
        self.assertEqual(self.server.process.wait(TIMEOUT_S), 0)
        self.assertEqual(deaf.reply.status, 200)

    def test_a_display_that_cannot_be_served_ends(self):
        player = self.play()
        player.next_part()
        self.server.command("refuse")
        self.assert_ends_with_its_picture(player)

    def assert_ends_with_its_picture(self, player):
        """An empty last part would take the picture from the screen."""
        before = player.jpeg
        while not player.has_ended:
            self.assertEqual(player.next_part(), before)
        self.assertIsNone(player.next_part())

    def test_head_tells_the_type_and_watches_nothing(self):
        player = self.play(method="HEAD")
        self.assertIn("multipart", player.reply.headers["content-type"])
        self.assertEqual(self.displays(), [])
        player.send(request_bytes(self.server.port, "/healthz"))
        self.assertEqual(player.read_reply().body, b"serving\n")

    def test_players_are_counted_among_the_displays_allowed(self):
        def at(focal_distance_m):
            display = quilt(4, 2, 320, 160, aspect=1, focal_distance_m=focal_distance_m)
            return "/stream/painted_qs4x2a1.mjpg?" + asked(display, stream=None)
        for index in range(64):
            self.play(at(index + 1)).next_part()
        refused = Player(self.server.port, at(65))
        self.addCleanup(refused.close)
        self.assertEqual(refused.reply.status, 503)
        self.assertIn("too many distinct displays", refused.reply.json()["error"]["message"])
        refused.send(request_bytes(self.server.port, "/healthz"))
        self.assertEqual(refused.read_reply().status, 200)

    def test_redirects_to_the_url_whose_suffix_says_how_views_lie(self):
        for target in ("/stream/painted/portrait", "/stream/painted/portrait.mjpg",
                       "/stream/painted_qs5x9a1.6.mjpg?preset=portrait"):
            reply = fetch(self.server.port, target)
            self.assertEqual((reply.status, reply.location),
                             (302, "/stream/painted_qs8x6a0.75.mjpg?preset=portrait"))

    def test_targets_that_name_no_stream(self):
        for target, status, field in (("/stream/painted", 404, "url"),
                                      ("/stream/painted_qs4x2a1.jpg", 404, "url"),
                                      ("/stream/none/portrait", 404, "stream"),
                                      ("/stream/painted/none", 404, "preset"),
                                      ("/stream/painted_qs0x0a0.mjpg", 400,
                                       "display.quilt.columns")):
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
