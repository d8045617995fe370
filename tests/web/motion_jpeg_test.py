# SPDX-License-Identifier: Apache-2.0
"""Motion JPEG as players show it: Chromium in an <img>, and ffmpeg and OpenCV where they are."""
import io
import os
import shutil
import subprocess
import sys
import time
import unittest

import numpy as np
from PIL import Image

from browser import CHROMIUM, Browser
from web_client import TIMEOUT_S, Server, fetch

STREAM = "stream/painted_qs4x2a1.mjpg?width=320&height=160"
STILL = "/still/painted_qs4x2a1.jpg?width=320&height=160"
# Less than the pause after which a picture that stands is repeated.
INTERVAL_S = 0.15
SHOW = """new Promise((done) => {
  window.player = new Image();
  document.body.append(player);
  window.pixels = (image) => {
    const canvas = new OffscreenCanvas(320, 160);
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, 320, 160).data;
  };
  window.read = async (target) =>
      pixels(await createImageBitmap(await (await fetch(target)).blob()));
  window.shows = (wanted) => player.naturalWidth === 320 && pixels(player).every(
      (value, index) => Math.abs(value - wanted[index]) <= 2);
  player.src = '/%s';
  done();
})"""
# Whether the newest still is shown before the time is over, s.
IN_TIME = """(async (seconds) => {
  const wanted = await read('%s');
  const end_ms = performance.now() + 1000 * seconds;
  while (!shows(wanted)) {
    if (performance.now() > end_ms) return false;
    await new Promise((done) => setTimeout(done, 5));
  }
  return true;
})"""
HAS_OPENCV = subprocess.run(["/usr/bin/python3", "-c", "import cv2"], capture_output=True,
                            check=False).returncode == 0


class Players(unittest.TestCase):
    def setUp(self):
        self.server = Server(PROGRAM)
        self.addCleanup(self.server.__exit__)

    def still(self):
        return np.asarray(Image.open(io.BytesIO(fetch(self.server.port, STILL).body)), float)

    def assert_shows_the_still(self, picture):
        self.assertLess(np.abs(np.asarray(picture, float) - self.still()).mean(), 3)


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class InChromium(Players):
    def setUp(self):
        super().setUp()
        self.browser = Browser()
        self.addCleanup(self.browser.close)
        self.browser.open(self.server.url + "icon.svg")  # of one origin, with no page's policy
        self.browser.open(self.server.url + "healthz")
        self.browser.wait_for("document.body !== null && location.pathname === '/healthz'")
        self.browser.evaluate(SHOW % STREAM)

    def shown_in_time(self, seconds):
        return self.browser.evaluate(f"{IN_TIME % STILL}({seconds})")

    def test_a_picture_that_stands_is_shown(self):
        self.assertTrue(self.shown_in_time(TIMEOUT_S))

    def test_a_picture_that_moves_is_shown_before_the_next_one_comes(self):
        self.assertTrue(self.shown_in_time(TIMEOUT_S))
        in_time = 0
        for _ in range(20):
            self.server.command("frame")
            time.sleep(0.02)  # until the server has painted it
            in_time += self.shown_in_time(INTERVAL_S)
        # On a busy machine not each one is, but of one picture late none would be.
        self.assertGreaterEqual(in_time, 3)

    def test_the_last_picture_stays_when_the_server_goes(self):
        self.assertTrue(self.shown_in_time(TIMEOUT_S))
        self.browser.evaluate(f"read('{STILL}').then((data) => {{ window.last = data; }})")
        self.assertEqual(self.server.stop(), 0)
        time.sleep(0.5)
        self.assertTrue(self.browser.evaluate("shows(last)"))


class InOthers(Players):
    @unittest.skipUnless(shutil.which("ffmpeg"), "there is no ffmpeg")
    def test_ffmpeg_reads_a_picture_that_stands(self):
        ran = subprocess.run(
            ["ffmpeg", "-v", "error", "-f", "mpjpeg", "-i", self.server.url + STREAM,
             "-frames:v", "1", "-f", "image2pipe", "-c:v", "png", "-"],
            capture_output=True, timeout=TIMEOUT_S, check=True)
        self.assert_shows_the_still(Image.open(io.BytesIO(ran.stdout)).convert("RGB"))

    @unittest.skipUnless(HAS_OPENCV, "there is no OpenCV for Python")
    def test_opencv_reads_a_picture_that_stands(self):
        script = ("import sys, cv2; ok, picture = cv2.VideoCapture(sys.argv[1]).read(); assert ok; "
                  "sys.stdout.buffer.write(cv2.imencode('.png', picture)[1])")
        ran = subprocess.run(["/usr/bin/python3", "-c", script, self.server.url + STREAM],
                             capture_output=True, timeout=TIMEOUT_S, check=True)
        self.assert_shows_the_still(Image.open(io.BytesIO(ran.stdout)).convert("RGB"))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
