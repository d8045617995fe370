# SPDX-License-Identifier: Apache-2.0
"""MP4 files of `viewloom`, as Chromium plays them, and as ffprobe reads them where it is.
Arguments: viewloomd, viewloom."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from browser import CHROMIUM, Browser
from live_page_test import CLIENT, LiveServer, Publisher
from web_client import TIMEOUT_S

PAGE = """<body><script>
window.video = document.createElement('video');
video.muted = true;
video.src = '%s';
document.body.append(video);
</script></body>"""
SEEK = """(async (seconds) => {
  const sought = new Promise((done) => { video.onseeked = done; });
  video.currentTime = seconds;
  await sought;
  return video.currentTime;
})"""
COUNT = 8


class VideoFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        server = LiveServer()
        cls.addClassCleanup(server.stop)
        publisher = Publisher(server)
        cls.addClassCleanup(publisher.stop)
        answer = subprocess.run(
            [CLIENT, "--server", f"127.0.0.1:{server.grpc_port}", "watch", "scene", "--columns",
             "4", "--rows", "2", "--size", "640x480", "--count", str(COUNT), "--video",
             os.path.join(cls.folder.name, "clip.mp4")],
            capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
        assert answer.returncode == 0, answer.stderr
        (name,) = os.listdir(cls.folder.name)
        cls.path = os.path.join(cls.folder.name, name)
        cls.printed = answer.stdout

    def test_its_name_says_the_layout_and_the_command_prints_it(self):
        self.assertRegex(self.path, r"/clip_qs4x2a[0-9.]+\.mp4$")
        self.assertIn(f"{self.path}: {COUNT} pictures of 640x480 px", self.printed)

    def test_the_index_stands_before_the_pictures(self):
        data = pathlib.Path(self.path).read_bytes()
        self.assertLess(data.index(b"moov"), data.index(b"mdat"))

    @unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
    def test_chromium_plays_and_seeks(self):
        page = os.path.join(self.folder.name, "page.html")
        with open(page, "w", encoding="utf-8") as file:
            file.write(PAGE % os.path.basename(self.path))
        self.addCleanup(os.remove, page)
        with Browser() as browser:
            browser.open("file://" + page)
            browser.wait_for("window.video && video.readyState >= 2")
            self.assertEqual(browser.evaluate("[video.videoWidth, video.videoHeight]"), [640, 480])
            duration_s = browser.evaluate("video.duration")
            self.assertGreater(duration_s, 0.1)
            half_s = duration_s / 2
            self.assertAlmostEqual(browser.evaluate(f"{SEEK}({half_s})"), half_s, delta=0.01)
            browser.evaluate("video.play().then(() => '')")
            browser.wait_for("video.ended")
            self.assertIsNone(browser.evaluate("video.error"))

    @unittest.skipUnless(shutil.which("ffprobe"), "there is no ffprobe (Debian package ffmpeg)")
    def test_ffprobe_reads_every_picture(self):
        said = json.loads(subprocess.run(
            ["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-show_format", "-of",
             "json", self.path], capture_output=True, check=True).stdout)
        (stream,) = said["streams"]
        self.assertEqual((stream["codec_name"], stream["width"], stream["height"]),
                         ("h264", 640, 480))
        self.assertEqual((stream["color_range"], stream["color_space"], stream["color_transfer"]),
                         ("pc", "smpte170m", "iec61966-2-1"))
        self.assertEqual(int(stream["nb_read_frames"]), COUNT)
        comment = json.loads(said["format"]["tags"]["comment"])
        self.assertEqual((comment["LKGColumns"], comment["LKGRows"], comment["LKGNumViews"]),
                         (4, 2, 8))
        self.assertEqual(said["format"]["tags"]["title"], "scene")


if __name__ == "__main__":
    unittest.main()
