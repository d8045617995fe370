# SPDX-License-Identifier: Apache-2.0
"""Looking around on the page: poses out, pictures in, before a server that shows a known scene.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import math
import os
import re
import socket
import time
import unittest

import numpy as np

import ray_scene
from browser import CHROMIUM, Browser
from page_test import LIVE, keep
from ray_server import CONE_RAD, RayServer

STAGE = "document.getElementById('stage')"
VIEWS = 48
# Poses as they go, and the contexts of WebGL.
RECORD = """
window.poses = [];
const send = WebSocket.prototype.send;
WebSocket.prototype.send = function(text) {
  if (String(text).startsWith('{"eye_poses"')) poses.push(text);
  send.call(this, text);
};
window.contexts = [];
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function(kind, ...others) {
  const context = getContext.call(this, kind, ...others);
  if (context && kind === 'webgl2' && !contexts.includes(context)) contexts.push(context);
  return context;
};"""
# The pointer moves; resolves with the number of poses that have gone by the end of the next frame.
MOVE = """new Promise((resolve) => requestAnimationFrame(() => {
  const {x, y, width, height} = document.getElementById('stage').getBoundingClientRect();
  poses.length = 0;
  document.getElementById('stage').dispatchEvent(new PointerEvent('pointermove', {
    clientX: x + %s * width, clientY: y + height / 2, pointerType: 'mouse', bubbles: true}));
  requestAnimationFrame(() => resolve(poses.length));
}))"""
PARTS = re.compile(r"(\d+) ms: (\d+) to the server, (\d+) waiting, (\d+) rendering, (\d+) back")


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class LookAround(unittest.TestCase):
    def start(self, query="", delay_s=0.0, size=(900, 640), scale=1,
              reprojection="off"):
        self.server = RayServer(delay_s=delay_s)
        self.addCleanup(self.server.close)
        self.browser = Browser(*size)
        self.addCleanup(self.browser.close)
        self.browser.resize(*size, scale=scale)
        self.browser.reduce_motion()
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source=RECORD)
        self.browser.open(f"{self.server.url}?stream=rays&reprojection={reprojection}{query}")
        self.browser.wait_for(LIVE)
        self.browser.wait_for(f"{STAGE}.dataset.view === '24'")
        self.wait_for(lambda: self.server.poses)

    def box(self):
        return self.browser.evaluate(f"(r => [r.x, r.y, r.width, r.height])"
                                     f"({STAGE}.getBoundingClientRect())")

    def point(self, share, height_share=0.5):
        left, top, width, height = self.box()
        return left + share * width, top + height_share * height

    def wait_for(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), deadline, self.browser.messages)
            time.sleep(0.05)

    def eye(self):
        return self.server.poses[-1]["eyes"][0]

    def place(self):
        return [self.eye()["pose"]["position"][axis] for axis in "xyz"]

    def picture(self, size):
        """What the canvas shows of the scene, scaled to that size in px."""
        scale = self.browser.evaluate("devicePixelRatio")
        left, top, width, height = (side * scale for side in self.box())
        shot = self.browser.screenshot().crop((left, top, left + width, top + height))
        # The page leaves a margin of 2.5 % of the shorter side.
        margin = round(0.025 * min(width, height))
        tall = min(height - 2 * margin, (width - 2 * margin) / 0.75)
        wide = 0.75 * tall
        area = ((width - wide) / 2, (height - tall) / 2, (width + wide) / 2, (height + tall) / 2)
        return np.asarray(shot.crop([round(side) for side in area]).resize(size))

    def asked(self):
        stereo = self.server.displays[-1]["stereo"]
        return stereo, (stereo["eye_size"]["width"], stereo["eye_size"]["height"])

    def score(self):
        """PSNR of the canvas against what the eye of the newest pose sees, dB."""
        _, size = self.asked()
        expected = ray_scene.look(ray_scene.Eye.of_message(self.eye(), *size), *size)[0]
        return ray_scene.psnr(self.picture(size), expected)

    def test_the_pointer_moves_one_eye_whose_view_is_as_large_as_the_canvas(self):
        self.start(scale=2)
        stereo, (width, height) = self.asked()
        self.assertEqual((stereo["layout"], stereo["tracked"]), ("STEREO_LAYOUT_SINGLE", True))
        _, _, box_width, box_height = self.box()
        shown = min(2 * 0.95 * box_height, 2 * 0.95 * box_width / 0.75)
        self.assertAlmostEqual(height, shown, delta=6)
        self.assertAlmostEqual(width, 0.75 * height, delta=3)
        for share in (0.1, 0.6, 0.95):
            self.browser.mouse(*self.point(share))
            view = round(share * (VIEWS - 1))
            self.browser.wait_for(f"{STAGE}.dataset.view === '{view}'")
            angle = CONE_RAD * ((share * (VIEWS - 1) + 0.5) / VIEWS - 0.5)
            self.assertAlmostEqual(self.place()[0], ray_scene.FOCAL_M * math.tan(angle),
                                   delta=0.02)
            self.assertGreater(self.score(), 22)
        keep(self.browser.screenshot(), "look_around")
        self.assertEqual(self.browser.messages, [])

    def test_a_drag_turns_the_wheel_and_keys_step_and_0_goes_back(self):
        self.start()
        self.browser.mouse(*self.point(0.5))
        begin, end = self.point(0.5), self.point(0.4, 0.6)
        self.browser.mouse(*begin, "mousePressed", button="left", buttons=1, clickCount=1)
        self.browser.mouse(*end, button="left", buttons=1)
        self.browser.mouse(*end, "mouseReleased", button="left", clickCount=1)
        self.wait_for(lambda: self.place()[0] > 0.5 and self.place()[1] > 0.2)
        middle = np.array((0, 0, -ray_scene.FOCAL_M))
        self.assertAlmostEqual(np.linalg.norm(self.place() - middle), ray_scene.FOCAL_M,
                               delta=0.05)
        self.browser.wait_for(f"{STAGE}.dataset.view")
        self.wait_for(lambda: self.score() > 22)
        keep(self.browser.screenshot(), "look_around_turned")
        self.browser.evaluate(f"{STAGE}.focus()")
        self.browser.key("w")
        self.wait_for(lambda: np.linalg.norm(self.place() - middle) < 0.97 * ray_scene.FOCAL_M)
        self.browser.key("0")
        self.wait_for(lambda: abs(self.place()[1]) < 1e-6 and abs(self.place()[2]) < 1e-6)
        self.browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=begin[0], y=begin[1],
                          deltaX=0, deltaY=100)
        self.wait_for(lambda: self.place()[2] > 0.1)

    def test_two_fingers_step_and_pan(self):
        self.start()
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        points = [self.point(0.4), self.point(0.6)]
        self.browser.touch("touchStart", *points)
        for step in range(1, 4):
            self.browser.touch("touchMove", self.point(0.4 - 0.05 * step),
                               self.point(0.6 + 0.05 * step))
        self.browser.touch("touchEnd")
        self.wait_for(lambda: self.place()[2] < -0.5)

    def slide(self, *shares):
        """Fingers upwards over the picture, from these places across it."""
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        self.browser.touch("touchStart", *(self.point(share, 0.7) for share in shares))
        for step in range(1, 6):
            self.browser.touch("touchMove", *(self.point(share, 0.7 - 0.08 * step)
                                              for share in shares))
        self.browser.touch("touchEnd")

    def test_two_fingers_pan_up_and_three_turn_and_the_page_does_not_scroll(self):
        self.start(size=(390, 844))  # higher than its window
        self.slide(0.3, 0.7)
        self.wait_for(lambda: self.place()[1] < -0.5)
        self.assertAlmostEqual(self.place()[2], 0, delta=0.2)
        self.slide(0.2, 0.5, 0.8)
        self.wait_for(lambda: self.place()[2] < -0.5)
        self.assertEqual(self.browser.evaluate("scrollY"), 0)

    def test_single_views_are_one_eye_that_stands(self):
        self.start("&mode=single")
        self.browser.click("#single-on")
        self.browser.wait_for(f"{STAGE}.dataset.view === '25'")
        angle = CONE_RAD * (25.5 / VIEWS - 0.5)
        self.assertAlmostEqual(self.place()[0], ray_scene.FOCAL_M * math.tan(angle), delta=1e-3)
        self.browser.mouse(*self.point(0.1))
        time.sleep(0.5)
        self.assertEqual(self.browser.evaluate(f"{STAGE}.dataset.view"), "25")

    def test_a_slow_server_is_asked_for_less_while_the_eye_moves_and_this_is_said(self):
        # Large enough for steps: no picture is lower than 360 px.
        self.start(delay_s=0.5, size=(1000, 1000))
        _, full = self.asked()
        deadline = time.monotonic() + 60
        share = 0.2
        said = ""
        while not said.startswith("Reduced detail for now"):
            self.assertLess(time.monotonic(), deadline, "nothing was said")
            share = 0.2 + (share + 0.013) % 0.6
            self.browser.mouse(*self.point(share))
            said = self.browser.evaluate("document.getElementById('reduced').textContent")
        heights = [display["stereo"]["eye_size"]["height"] for display in self.server.displays]
        shown_px, full_px = map(int, re.findall(r"\d+", said))
        self.assertAlmostEqual(full_px, full[0], delta=2)
        self.assertLess(shown_px, full_px)
        self.assertLess(min(heights), full[1])
        self.assertGreaterEqual(min(heights), 360)
        self.wait_for(lambda: self.asked()[1] == full)
        self.browser.wait_for("document.getElementById('reduced').hidden")

    def test_motion_to_picture_is_told_in_parts_that_add_up(self):
        self.start(delay_s=0.2)
        deadline = time.monotonic() + 30
        text = ""
        while not PARTS.search(text) and time.monotonic() < deadline:
            self.browser.mouse(*self.point(0.3 + 0.4 * (time.monotonic() % 1)))
            text = self.browser.evaluate("document.getElementById('facts').textContent")
        total, *parts = map(int, PARTS.search(text).groups())
        self.assertGreaterEqual(total, 190)
        # Clocks are compared to a few ms, and no part is shown below 0.
        self.assertAlmostEqual(total, sum(parts), delta=5 + 0.1 * total)
        self.assertTrue(self.server.presented)

    def test_the_picture_follows_before_the_server_answers(self):
        self.start(delay_s=20, reprojection="on")
        self.browser.mouse(*self.point(0.6))
        self.wait_for(lambda: self.place()[0] > 0.1)
        self.wait_for(lambda: self.score() > 18)
        self.assertEqual(self.browser.evaluate(f"{STAGE}.dataset.view"), "24", "not yet answered")
        keep(self.browser.screenshot(), "reprojected")

    def test_a_pose_goes_in_the_frame_that_follows_the_pointer(self):
        self.start()
        for share in (0.2, 0.7):
            self.assertEqual(self.browser.evaluate(MOVE % share), 1)

    def test_without_its_graphics_device_the_page_asks_for_no_depth(self):
        self.start(reprojection="on")
        self.assertTrue(self.server.viewers[-1].with_depth)
        self.browser.evaluate(
            "contexts.forEach(gl => gl.getExtension('WEBGL_lose_context').loseContext())")
        self.wait_for(lambda: not self.server.viewers[-1].with_depth)
        self.browser.mouse(*self.point(0.3))
        self.browser.wait_for(f"{STAGE}.dataset.view === '14'")
        self.wait_for(lambda: self.score() > 22)

    def test_without_a_gpu_there_is_no_reprojection_unless_it_is_asked_for(self):
        self.start(reprojection="auto")
        is_on = "import('/late_picture.js').then(({LatePicture}) => new LatePicture(%r).isOn)"
        self.assertFalse(self.browser.evaluate(is_on % "auto"))
        self.assertFalse(self.browser.evaluate(is_on % "off"))
        self.assertTrue(self.browser.evaluate(is_on % "on"))

    def test_a_limit_of_the_server_is_named_until_there_is_room(self):
        self.start()
        self.server.refusals["STEREO_LAYOUT_SINGLE"] = {
            "code": "RESOURCE_EXHAUSTED", "field": "",
            "message": "too many distinct displays; raise limits.displays_max"}
        self.server.viewers[-1].connection.connection.shutdown(socket.SHUT_RDWR)
        notice = "document.getElementById('notice').textContent"
        self.browser.wait_for(f"{notice}.includes('raise limits.displays_max. Trying again.')")
        self.server.refusals.clear()
        self.browser.wait_for(f"{LIVE} && {notice} === ''")

    def test_an_eye_without_a_place_is_never_sent(self):
        self.start()
        count = len(self.server.poses)
        self.browser.evaluate(
            "import('/eye_poses.js').then(({EyePoses}) => { window.went = "
            "new EyePoses(() => true).put([{pose: {position: {x: NaN}}}], {}); })")
        self.browser.wait_for("window.went === false")
        self.assertEqual(len(self.server.poses), count)


if __name__ == "__main__":
    unittest.main()
