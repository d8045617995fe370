# SPDX-License-Identifier: Apache-2.0
"""Late reprojection in a browser, against what an eye there really sees. With --figures it prints
what tests/performance.md keeps: gain at 100 ms of latency, and bytes of compact depth."""
import base64
import json
import math
import os
import sys
import unittest

import numpy as np

import ray_scene
from browser import CHROMIUM, Browser
from ray_server import RayServer

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = {"width": 320, "height": 240}
LATENCY_S = 0.1


def turned(angle_rad):
    """About up."""
    return (0, math.sin(angle_rad / 2), 0, math.cos(angle_rad / 2))


def eye_at(x, y=0.0, z=0.0, turn_rad=0.0, size=None):
    """Looks with one field of view, in the direction that it has."""
    width, height = (size or SIZE).values()
    focal = 1.1 * height
    return ray_scene.Eye((x, y, z), turned(turn_rad), (focal, focal), (width / 2, height / 2))


def message(eye, size=None):
    """The eye as a Camera of the protocol."""
    width, height = (size or SIZE).values()
    pose = eye.message()["pose"]
    half_x, half_y = 0.5 * width / eye.focal[0], 0.5 * height / eye.focal[1]
    return {"pose": pose, "fov": {
        "angle_left_rad": -math.atan(half_x), "angle_right_rad": math.atan(half_x),
        "angle_up_rad": math.atan(half_y), "angle_down_rad": -math.atan(half_y)}}


def truth(eye, size=None):
    width, height = (size or SIZE).values()
    return ray_scene.look(eye, width, height)[0]


def sideways(time_s, size):
    return eye_at(0.5 * math.sin(2 * math.pi * 0.3 * time_s), size=size)


def free(time_s, size):
    swing = 2 * math.pi * 0.3 * time_s
    return eye_at(0.4 * math.sin(swing), 0.2 * math.sin(1.3 * swing), 0.3 * math.sin(0.7 * swing),
                  0.1 * math.sin(swing), size)


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class Reprojection(unittest.TestCase):
    def setUp(self):
        self.server = RayServer(folders=(HERE,))
        self.addCleanup(self.server.close)
        self.browser = Browser(400, 300)
        self.addCleanup(self.browser.close)
        self.browser.open(self.server.url + "reprojection_harness.html")
        self.browser.wait_for("window.isReady")
        self.open_eyes()

    def open_eyes(self, layout="SINGLE", size=None):
        width, height = (size or SIZE).values()
        self.browser.evaluate(f"open_eyes('STEREO_LAYOUT_{layout}', {width}, {height})")

    def see(self, *eyes, size=None):
        return self.browser.evaluate(f"see({json.dumps([message(eye, size) for eye in eyes])})")

    def shown_from(self, eye, view=0, size=None):
        shown = self.browser.evaluate(
            f"show_from({json.dumps(eye.message())}, {json.dumps(size or SIZE)}, {view})")
        width, height = (size or SIZE).values()
        pixels = np.frombuffer(base64.b64decode(shown["pixels"]), np.uint8)
        return pixels.reshape(height, width, 4)[::-1, :, :3]

    def test_where_the_eye_stands_the_picture_is_shown_as_it_came(self):
        eye = eye_at(0.1, 0.05, -0.2, 0.1)
        self.see(eye)
        self.assertGreater(ray_scene.psnr(self.shown_from(eye), truth(eye)), 30)

    def test_a_picture_is_moved_to_where_the_eye_is_by_now(self):
        for move in ((0.12, 0, 0, 0), (0, 0.1, 0, 0), (0, 0, 0.25, 0), (0, 0, -0.25, 0),
                     (0, 0, 0, 0.05)):
            self.browser.evaluate("forget()")
            self.see(eye_at(0, 0, 0))
            expected = truth(eye_at(*move))
            stale = ray_scene.psnr(truth(eye_at(0)), expected)
            moved = ray_scene.psnr(self.shown_from(eye_at(*move)), expected)
            self.assertGreater(moved, stale + 4, f"moved by {move}: {moved:.1f} dB")

    def test_older_pictures_show_what_the_newest_hides(self):
        target = eye_at(-0.05)
        self.browser.evaluate("forget()")
        self.see(eye_at(0.25))
        alone = ray_scene.psnr(self.shown_from(target), truth(target))
        self.browser.evaluate("forget()")
        self.see(eye_at(-0.3))  # sees the other side of the balls
        self.see(eye_at(0.25))
        self.assertGreater(ray_scene.psnr(self.shown_from(target), truth(target)), alone + 1)

    def test_each_of_two_eyes_is_shown_from_its_own_picture(self):
        self.open_eyes("SIDE_BY_SIDE")
        pair = (eye_at(-0.2), eye_at(0.2))
        self.see(*pair)
        for view, eye in enumerate(pair):
            shown = self.shown_from(eye, view)
            self.assertGreater(ray_scene.psnr(shown, truth(eye)), 28)
            self.assertLess(ray_scene.psnr(shown, truth(pair[1 - view])), 20)

    def test_100_ms_of_latency_are_mostly_hidden(self):
        for motion in (sideways, free):
            with_it, without = self.latency_scores(motion, SIZE, 4)
            self.assertGreater(with_it - without, 8, motion.__name__)

    def latency_scores(self, motion, size, count):
        """Mean PSNR of the picture on the screen, with reprojection and without, dB."""
        self.browser.evaluate("forget()")
        with_it, without = [], []
        for index in range(count + 2):
            shown_s = 0.31 * index
            seen, target = motion(shown_s - LATENCY_S, size), motion(shown_s, size)
            self.see(seen, size=size)
            expected = truth(target, size)
            if index < 2:
                continue  # there is nothing older yet
            with_it.append(ray_scene.psnr(self.shown_from(target, size=size), expected))
            without.append(ray_scene.psnr(truth(seen, size), expected))
        return np.mean(with_it), np.mean(without)


class Figures(Reprojection):
    """Runs with --figures alone."""

    def test_figures(self):
        size = {"width": 1280, "height": 720}
        self.open_eyes(size=size)
        for motion in (sideways, free):
            with_it, without = self.latency_scores(motion, size, 4)
            print(f"{motion.__name__}: {with_it:.1f} dB with late reprojection, {without:.1f} "
                  f"without, gain {with_it - without:.1f} dB at {LATENCY_S * 1000:.0f} ms")
        bytes_ = self.see(free(0.2, size), size=size)
        print(f"1280x720: depth {bytes_['depth'] / 1000:.1f} kB a picture, "
              f"{bytes_['depth'] * 8 * 20 / 1e6:.1f} Mbit/s at 20 Hz; "
              f"JPEG {bytes_['jpeg'] / 1000:.1f} kB")


if __name__ == "__main__":
    if "--figures" in sys.argv:
        sys.argv.remove("--figures")
        unittest.main(argv=[sys.argv[0], "Figures.test_figures"])
    unittest.main(argv=[*sys.argv, *([] if sys.argv[1:] else ["Reprojection"])])
