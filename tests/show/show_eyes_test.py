# SPDX-License-Identifier: Apache-2.0
"""`viewloom show --eyes-from`: a tracked stereo pair on the screen is what the newest eyes see."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

VIEWLOOM, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import numpy

from known_pictures import SMALL, paint_views, quilt_of
from show_case import ShowTest

EYE_PX = (160, 200)
SCREEN_PX = (320, 200)
PATIENCE_S = 120
TRACKED = {"stereo": {"eyeSize": {"width": 160, "height": 200}, "focalDistanceM": 0.6,
                      "tracked": True}}
# View number `place` is what an eye sees from `place` cm to the right.
VIEWS = paint_views(10, *EYE_PX)


def line(left, right, time_ns=0):
    return json.dumps({"time_ns": time_ns, "left": [left / 100, 0, 0.1],
                       "right": [right / 100, 0.02, 0.1]}) + "\n"


def side_by_side(left, right):
    return quilt_of([VIEWS[left], VIEWS[right]], 2)


def seen_by(poses):
    return side_by_side(*(round(100 * eye.pose.position.x) for eye in poses.eyes))


class Eyes(ShowTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.screen = self.start_screen(SCREEN_PX)
        self.server = self.start_server(lambda asked: side_by_side(0, 9), see=seen_by)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def show_eyes(self, eyes, *arguments, display=None, **options):
        display = self.write("display.json", json.dumps(display or TRACKED))
        return self.start_show(self.screen, self.server, "--display", display, "--eyes-from", eyes,
                               *arguments, **options)

    def expect_pair(self, left, right):
        self.expect_screen(self.screen, numpy.hstack([VIEWS[left], VIEWS[right]]))

    def test_a_pipe_moves_both_eyes_and_its_end_leaves_them(self):
        reader, writer = os.pipe()
        with os.fdopen(reader) as pipe, os.fdopen(writer, "w") as tracker:
            self.show_eyes("-", stdin=pipe)
            self.expect_pair(0, 9)
            asked = self.server.displays.get(timeout=PATIENCE_S)
            self.assertTrue(asked.stereo.tracked)
            self.assertEqual(asked.stereo.eye_size.width, EYE_PX[0])
            for left, right in ((1, 2), (6, 8)):
                tracker.write(line(left, right))
                tracker.flush()
                self.expect_pair(left, right)
        self.screen.press("Up")
        self.assertAlmostEqual(self.server.displays.get(timeout=PATIENCE_S).stereo.focal_distance_m,
                               2.0 * 1.05)

    def test_a_file_is_played_to_its_end(self):
        eyes = self.write("eyes.jsonl", line(1, 2, 0) + line(3, 4, 10**8) + line(5, 7, 2 * 10**8))
        self.show_eyes(eyes)
        self.expect_pair(5, 7)

    def test_one_eye_alone(self):
        eyes = self.write("eyes.jsonl", line(3, 5))
        self.show_eyes(eyes, "--mode", "view", "--view", 1)
        shown = numpy.zeros((200, 320, 3))
        shown[:, 80:240] = VIEWS[5]
        self.expect_screen(self.screen, shown)

    def test_what_is_no_pose_ends_it_with_its_line(self):
        eyes = self.write("eyes.jsonl", line(1, 2) + '{"time_ns": 0, "left": [0, 0, 0]}\n')
        show = self.show_eyes(eyes)
        self.assertEqual(show.exit_code(), 2)
        self.assertIn(f"eyes of {eyes}, line 2: right: missing", show.said())

    def test_eyes_that_nothing_follows_are_refused(self):
        eyes = self.write("eyes.jsonl", line(1, 2))
        fixed = {"stereo": {"eyeSize": {"width": 160, "height": 200}}}
        for arguments, options, sentence in (
                ((eyes,), {"display": fixed}, '--eyes-from needs a display that tracks a head'),
                ((eyes, "--mode", "native"), {}, "--mode native is for a panel"),
                ((self.folder / "gone",), {}, "gone: cannot be read: No such file")):
            with self.subTest(sentence=sentence):
                show = self.show_eyes(*arguments, **options)
                self.assertEqual(show.exit_code(), 2)
                self.assertIn(sentence, show.said())
        show = self.show_eyes(eyes, "--calibration", self.calibration_file(SMALL))
        self.assertNotEqual(show.exit_code(), 0)
        self.assertIn("cannot be combined", show.said())


if __name__ == "__main__":
    ShowTest.viewloom = VIEWLOOM
    unittest.main(verbosity=2)
