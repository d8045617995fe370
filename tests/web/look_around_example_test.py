# SPDX-License-Identifier: Apache-2.0
"""The example of looking around without the viewer page, from another origin than the server's."""
import os
import time
import unittest

import numpy as np

import ray_scene
from browser import CHROMIUM, Browser
from ray_server import RayServer

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "client",
                        "examples")
LINES_MAX = 32


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class LookAroundExample(unittest.TestCase):
    def test_the_picture_follows_the_pointer(self):
        pages = RayServer(folders=(EXAMPLES,))  # another port is another origin
        self.addCleanup(pages.close)
        scene = RayServer()
        self.addCleanup(scene.close)
        browser = Browser(1000, 600)
        self.addCleanup(browser.close)
        browser.open(f"{pages.url}look_around.html?stream=rays"
                     f"&server=127.0.0.1:{scene.server_address[1]}")
        browser.wait_for("document.readyState === 'complete'")
        left, top = browser.evaluate("(r => [r.x, r.y])(document.getElementById('view')"
                                     ".getBoundingClientRect())")
        deadline = time.monotonic() + 60
        # Until the connection is there, nothing hears of the pointer.
        while not browser.evaluate("document.title.startsWith('motion to picture: ')"):
            self.assertLess(time.monotonic(), deadline)
            browser.mouse(left + 240, top + 135)
            time.sleep(0.2)
        shot = np.asarray(browser.screenshot().crop((left, top, left + 960, top + 540)))
        eye = ray_scene.Eye.of_message(scene.poses[-1]["eyes"][0], 960, 540)
        np.testing.assert_allclose(eye.position, (-0.25, 0.25, 0), atol=0.01)
        self.assertGreater(ray_scene.psnr(shot, ray_scene.look(eye, 960, 540)[0]), 28)
        self.assertEqual(browser.messages, [])

    def test_it_is_as_short_as_its_document_says(self):
        with open(os.path.join(EXAMPLES, "look_around.js"), encoding="utf-8") as file:
            self.assertLessEqual(len(file.readlines()), LINES_MAX)


if __name__ == "__main__":
    unittest.main()
