# SPDX-License-Identifier: Apache-2.0
"""Live MP4, taken apart by a reader that shares no code with the server, and as players show it."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from browser import CHROMIUM, Browser
from web_client import TIMEOUT_S, Server, Stream, asked, fetch, quilt, request_bytes

PROGRAM = sys.argv.pop(1)
SMALL = "/stream/painted_qs4x2a1.mp4?width=320&height=160"
LARGE = "/stream/painted_qs8x6a0.75.mp4?preset=portrait"
COMMENT = {"LKGNumViews": 8, "LKGRows": 2, "LKGColumns": 4, "LKGAspect": 1, "LKGType": "quilt"}


def boxes(data):
    """(type, content) of each box."""
    at = 0
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        assert 8 <= size <= len(data) - at, (kind, size)
        yield kind.decode("latin-1"), data[at + 8:at + size]
        at += size


def box(data, path):
    for kind in path.split("/"):
        data = next(content for found, content in boxes(data) if found == kind)
    return data


class Player(Stream):
    """Reads the boxes of a live MP4."""

    def __init__(self, port, target, method="GET"):
        super().__init__(port)
        self.send(request_bytes(port, target, method))
        self.reply = self.read_reply()

    def next_box(self):
        """(type, content), or None at the end."""
        head = self.file.read(8)
        if not head:
            return None
        size, kind = struct.unpack(">I4s", head)
        return kind.decode("latin-1"), self.file.read(size - 8)

    def next_fragment(self):
        """(number, begin and duration in ticks, whether it is a sync sample, sample)."""
        kind, moof = self.next_box()
        assert kind == "moof", kind
        kind, sample = self.next_box()
        assert kind == "mdat", kind
        (number,) = struct.unpack_from(">I", box(moof, "mfhd"), 4)
        (begin,) = struct.unpack_from(">Q", box(moof, "traf/tfdt"), 4)
        _, offset, duration, size, flags = struct.unpack_from(">IIIII", box(moof, "traf/trun"), 4)
        assert (offset, size) == (len(moof) + 16, len(sample))
        return number, begin, duration, flags == 0x02000000, sample


class Movies(unittest.TestCase):
    def start(self, *options):
        self.server = Server(PROGRAM, *options)
        self.addCleanup(self.server.__exit__)

    def play(self, target=SMALL, **options):
        player = Player(self.server.port, target, **options)
        self.addCleanup(player.close)
        return player

    def test_a_head_and_a_fragment_for_each_atlas(self):
        self.start()
        player = self.play()
        self.assertEqual(player.reply.status, 200, player.reply.body)
        headers = player.reply.headers
        self.assertEqual(headers["content-type"], "video/mp4")
        self.assertEqual(headers["viewloom-picture-size"], "320x160")
        self.assertNotIn("viewloom-scaled-from", headers)
        self.assertIn("painted_qs4x2a1.mp4", headers["content-disposition"])
        self.assertEqual(player.next_box()[0], "ftyp")
        kind, moov = player.next_box()
        self.assertEqual(kind, "moov")
        entry = box(moov, "trak/mdia/minf/stbl/stsd")[8:]
        self.assertEqual(struct.unpack_from(">HH", box(entry, "avc1"), 24), (320, 160))
        tags = dict(boxes(box(box(moov, "udta/meta")[4:], "ilst")))
        self.assertEqual(json.loads(tags["\xa9cmt"][16:]), COMMENT)
        fragments = [player.next_fragment()]
        for _ in range(3):
            time.sleep(0.1)
            self.server.command("frame")
            fragments.append(player.next_fragment())
        self.assertEqual([fragment[0] for fragment in fragments], [1, 2, 3, 4])
        begins = [fragment[1] for fragment in fragments]
        self.assertEqual(begins[0], 0)
        self.assertEqual(begins, sorted(set(begins)))
        self.assertTrue(fragments[0][3], "players may begin with the first one")

    def test_a_picture_that_stands_is_coded_again_each_second(self):
        self.start()
        player = self.play()
        player.next_box(), player.next_box()
        fragments = [player.next_fragment() for _ in range(4)]
        steps = [after[1] - before[1] for before, after in zip(fragments, fragments[1:])]
        for step in steps:
            self.assertGreater(step, 0.9 * 90000)
        self.assertLess(len(fragments[1][4]), 0.2 * len(fragments[0][4]))

    def test_quilts_over_the_limit_of_the_codec_are_scaled_and_say_so(self):
        self.start()
        headers = self.play(LARGE, method="HEAD").reply.headers
        self.assertEqual(headers["viewloom-picture-size"], "3072x3072")
        self.assertEqual(headers["viewloom-scaled-from"], "3360x3360")
        self.assertIn("painted_3072x3072_qs8x6a0.75.mp4", headers["content-disposition"])

    def test_redirects_to_the_url_whose_suffix_says_how_views_lie(self):
        self.start()
        reply = fetch(self.server.port, "/stream/painted/portrait.mp4")
        self.assertEqual((reply.status, reply.location), (302, LARGE))

    def test_displays_that_are_no_views_are_refused(self):
        self.start()
        reply = fetch(self.server.port, "/stream/painted.mp4?" + asked(
            {"rgbd": {"viewSize": {"width": 320, "height": 180}}}, stream=None))
        self.assertEqual(reply.status, 400, reply.body)
        self.assertIn("H264 is for views", reply.json()["error"]["message"])

    def test_places_are_limited_and_given_back(self):
        self.start()
        players = [self.play() for _ in range(4)]
        for player in players:
            self.assertEqual(player.reply.status, 200)
            player.next_box()
        refused = self.play()
        self.assertEqual(refused.reply.status, 503)
        self.assertIn("http.videos_max", refused.reply.json()["error"]["message"])
        players[0].close()
        deadline = time.monotonic() + TIMEOUT_S
        while self.play().reply.status != 200:
            self.assertLess(time.monotonic(), deadline, "the place stays taken")
            time.sleep(0.05)

    def test_a_draining_server_ends_between_two_fragments(self):
        self.start()
        player = self.play()
        player.next_box(), player.next_box(), player.next_fragment()
        self.server.process.stdin.close()
        while (found := player.next_box()) is not None:
            self.assertIn(found[0], ("moof", "mdat"))
        self.assertEqual(self.server.process.wait(TIMEOUT_S), 0)

    @unittest.skipUnless(shutil.which("ffprobe"), "there is no ffprobe (Debian package ffmpeg)")
    def test_ffprobe_reads_it(self):
        self.start("--rate-hz", 10)
        player = self.play()
        with tempfile.NamedTemporaryFile(suffix=".mp4") as file:
            for _ in range(2 + 2 * 12):
                kind, content = player.next_box()
                file.write(struct.pack(">I4s", len(content) + 8, kind.encode()) + content)
            file.flush()
            said = json.loads(subprocess.run(
                ["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-show_format",
                 "-of", "json", file.name], capture_output=True, check=True).stdout)
        (stream,) = said["streams"]
        self.assertEqual((stream["codec_name"], stream["width"], stream["height"]),
                         ("h264", 320, 160))
        self.assertEqual((stream["color_range"], stream["color_space"]), ("pc", "smpte170m"))
        self.assertEqual(stream["nb_read_frames"], "12")
        self.assertEqual(json.loads(said["format"]["tags"]["comment"]), COMMENT)


PLAY = """new Promise((done) => {
  window.video = document.createElement('video');
  video.muted = true;
  document.body.append(video);
  video.src = '%s';
  video.play().then(() => done(''), (error) => done(String(error)));
})"""


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class InChromium(unittest.TestCase):
    def test_it_plays_in_a_video_element(self):
        server = Server(PROGRAM, "--rate-hz", 10)
        self.addCleanup(server.__exit__)
        browser = Browser()
        self.addCleanup(browser.close)
        browser.open(server.url + "healthz")
        browser.wait_for("document.body !== null && location.pathname === '/healthz'")
        self.assertEqual(browser.evaluate(PLAY % SMALL), "")
        browser.wait_for("video.currentTime > 1")
        self.assertEqual(browser.evaluate("[video.videoWidth, video.videoHeight]"), [320, 160])
        self.assertIsNone(browser.evaluate("video.error"))


if __name__ == "__main__":
    unittest.main()
