# SPDX-License-Identifier: Apache-2.0
"""The page in an emulated headset: npm's iwer in headless Chromium, before ray_scene.py."""
import os
import pathlib
import re
import sys
import tempfile
import time
import unittest

import numpy as np

import ray_scene
from browser import CHROMIUM, Browser
from ray_server import RayServer

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "node"))
import npm  # noqa: E402

FACTS = "document.getElementById('facts').textContent"
IWER = "iwer@2.5.0"
EYE = (320, 320)  # px
# The headset's canvas covers the window, half of it for each eye.
INSTALL = """
const device = new IWER.XRDevice(IWER.metaQuest3, {stereoEnabled: true, ipd: 0.06});
device.installRuntime({forceInstall: true});
window.headset = device;
"""
emulator = None


def prepare():
    global emulator
    with tempfile.TemporaryDirectory() as folder:
        npm.install("install", IWER, cwd=folder)
        emulator = pathlib.Path(
            folder, "node_modules/iwer/build/iwer.min.js").read_text(encoding="utf-8")


def vector(place):
    return [place.get(axis, 0) for axis in "xyz"]


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class Headset(unittest.TestCase):
    def setUp(self):
        self.server = RayServer()
        self.addCleanup(self.server.close)
        self.browser = Browser(2 * EYE[0], EYE[1])
        self.addCleanup(self.browser.close)
        self.browser.reduce_motion()
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=emulator + INSTALL)
        self.browser.open(self.server.url + "?stream=rays")
        self.browser.wait_for("document.documentElement.dataset.state === 'live'")

    def press(self):
        self.browser.wait_for("!document.getElementById('vr').hidden")
        self.server.poses.clear()
        self.browser.evaluate("document.getElementById('vr').click()")

    def enter(self):
        self.press()
        self.browser.wait_for("document.getElementById('vr').textContent === 'Leave VR'")
        self.wait_for(lambda: self.pairs())

    def wait_for(self, condition):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), deadline, self.browser.messages)
            time.sleep(0.05)

    def pairs(self):
        return [poses for poses in list(self.server.poses) if len(poses["eyes"]) == 2]

    def newest(self):
        return self.pairs()[-1]["eyes"]

    def move(self, x, y, z):
        """The head, by so much from where it was at first. Waits until the poses say so."""
        self.browser.evaluate(f"headset.position.set({x}, {1.6 + y}, {z})")
        self.wait_for(lambda: abs(self.middle()[0] - x) < 1e-3)

    def middle(self):
        left, right = (np.array(vector(eye["pose"]["position"])) for eye in self.newest())
        return (left + right) / 2

    def test_two_eyes_have_the_poses_and_fields_of_view_of_the_headset(self):
        self.enter()
        self.assertEqual(self.server.displays[-1]["stereo"]["layout"],
                         "STEREO_LAYOUT_SIDE_BY_SIDE")
        self.move(0.3, 0, 0)
        left, right = self.newest()
        apart = np.array(vector(right["pose"]["position"])) - vector(left["pose"]["position"])
        np.testing.assert_allclose(apart, (0.06, 0, 0), atol=1e-4)
        fov = left["fov"]
        self.assertAlmostEqual(fov["angle_up_rad"] - fov["angle_down_rad"],
                               self.browser.evaluate("headset.fovy"), delta=1e-3)
        self.assertAlmostEqual(fov["angle_left_rad"], -fov["angle_right_rad"], delta=1e-3)

    def test_each_eye_sees_the_scene_from_its_place(self):
        self.enter()
        self.move(0.2, 0, 0)
        self.wait_for(lambda: self.similarity()[0] > 24)
        own, others = self.similarity()
        self.assertGreater(own, 24)
        self.assertGreater(own, others + 2, "left and right are the right way round")

    def similarity(self):
        """PSNR of the halves of the screen against the views of their own eyes, and of the other
        ones, dB; the worse of both."""
        shot = self.browser.screenshot()
        width, height = shot.width // 2, shot.height
        halves = [np.asarray(shot.crop((side * width, 0, (side + 1) * width, height)))
                  for side in range(2)]
        views = [ray_scene.look(ray_scene.Eye.of_message(eye, width, height), width, height)[0]
                 for eye in self.newest()]
        if (folder := os.environ.get("VIEWLOOM_SCREENSHOTS")):
            shot.save(os.path.join(folder, "headset.png"))
        return (min(ray_scene.psnr(halves[side], views[side]) for side in range(2)),
                min(ray_scene.psnr(halves[side], views[1 - side]) for side in range(2)))

    def test_sticks_step_around(self):
        self.enter()
        before = self.middle()
        self.browser.evaluate("headset.controllers.left.updateAxes('thumbstick', 0, -1)")
        self.wait_for(lambda: self.middle()[2] < before[2] - 0.2)
        self.browser.evaluate("headset.controllers.left.updateAxes('thumbstick', 0, 0)")
        self.browser.evaluate("headset.controllers.right.updateAxes('thumbstick', 1, 0)")
        self.wait_for(lambda: self.newest()[0]["pose"]["orientation"]["y"] < -0.2)

    def test_motion_to_picture_is_told_beside_the_headset(self):
        self.server.delay_s = 0.4
        self.enter()
        total_ms, x_m = 0, 0.0
        deadline = time.monotonic() + 60
        while total_ms < 390:
            facts = self.browser.evaluate(FACTS)
            self.assertLess(time.monotonic(), deadline, facts)
            x_m += 0.01
            self.browser.evaluate(f"headset.position.set({x_m}, 1.6, 0)")
            found = re.search(r"(\d+) ms: \d+ to the server", facts)
            total_ms = int(found.group(1)) if found else 0
            time.sleep(1)  # a headset that moves all the time takes a slow machine for itself

    def test_a_refusal_ends_the_stay_and_is_said(self):
        self.server.refusals["STEREO_LAYOUT_SIDE_BY_SIDE"] = {
            "code": "PERMISSION_DENIED", "field": "stream",
            "message": "This stream is not for headsets."}
        self.press()
        self.browser.wait_for("document.getElementById('notice').textContent"
                              ".includes('not for headsets')")
        self.browser.wait_for("document.documentElement.dataset.state === 'live'")
        self.assertEqual(self.browser.evaluate("document.getElementById('vr').textContent"),
                         "Enter VR")
        self.assertIn("not for headsets", self.browser.evaluate(
            "document.getElementById('notice').textContent"))
        self.assertEqual(self.browser.messages, [])

    def test_the_session_ends_cleanly_and_the_page_goes_on(self):
        self.enter()
        shown = len(self.server.displays)
        self.browser.evaluate("document.getElementById('vr').click()")
        self.browser.wait_for("document.getElementById('vr').textContent === 'Enter VR'")
        self.browser.wait_for("document.documentElement.dataset.state === 'live'")
        self.assertEqual(self.server.displays[shown]["stereo"]["layout"], "STEREO_LAYOUT_SINGLE")
        self.server.poses.clear()
        time.sleep(0.5)
        self.assertEqual(self.pairs(), [])
        self.enter()  # and once more
        self.assertEqual(self.browser.messages, [])


if __name__ == "__main__":
    npm.require(prepare)
    unittest.main()
