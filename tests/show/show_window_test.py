# SPDX-License-Identifier: Apache-2.0
"""`viewloom show` as it is used: modes, keys, a server that goes and comes, wrong arguments."""

import json
import sys
import time
import unittest

VIEWLOOM, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import numpy

from fake_displays import Atlas
from known_pictures import PORTRAIT, SMALL, paint_views, quilt_of
from reference_weave import resized
from show_case import ShowTest

SIZE_PX = (320, 200)
PATIENCE_S = 120
# Cards blend neighbouring texels with 8 bits.
SCALED = 1.5


def pair_of(left, right):
    """Two views beside each other, each over its half of the window, black above and below."""
    shown = numpy.zeros((200, 320, 3))
    shown[50:150, :160] = resized(left, 160, 100)
    shown[50:150, 160:] = resized(right, 160, 100)
    return shown


class Modes(ShowTest):
    def setUp(self):
        self.views = paint_views(16, *SIZE_PX)
        self.screen = self.start_screen(SIZE_PX)
        self.server = self.start_server(lambda asked: quilt_of(self.views, 4, 6, 3))

    def test_a_view_is_shown_px_by_px(self):
        self.start_show(self.screen, self.server, "--mode", "view", "--view", 5)
        self.expect_screen(self.screen, self.views[5])

    def test_without_a_calibration_it_is_the_view_in_the_middle(self):
        self.start_show(self.screen, self.server, "--mode", "view")
        self.expect_screen(self.screen, self.views[8])

    def test_a_pair_stands_side_by_side(self):
        self.start_show(self.screen, self.server, "--mode", "pair", "--view", 3,
                        "--pair-distance", 4)
        self.expect_screen(self.screen, pair_of(self.views[3], self.views[7]), tolerance=SCALED)

    def test_the_quilt_is_shown_whole(self):
        self.start_show(self.screen, self.server, "--mode", "quilt")
        atlas = quilt_of(self.views, 4, 6, 3)
        height, width = atlas.picture.shape[:2]
        fitted = round(200 * width / height)
        left = (320 - fitted) // 2
        shown = numpy.zeros((200, 320, 3))
        shown[:, left:left + fitted] = resized(atlas.picture.astype(float), fitted, 200)
        self.expect_screen(self.screen, shown, tolerance=SCALED)


class Keys(ShowTest):
    def setUp(self):
        self.views = paint_views(16, *SIZE_PX)
        self.screen = self.start_screen(SIZE_PX)
        self.server = self.start_server(lambda asked: quilt_of(self.views, 4))
        self.show = self.start_show(self.screen, self.server, "--mode", "view", "--view", 5)
        self.expect_screen(self.screen, self.views[5])
        self.asked = self.server.displays.get(timeout=PATIENCE_S)

    def test_arrows_step_from_view_to_view(self):
        self.screen.press("Right")
        self.expect_screen(self.screen, self.views[6])
        self.screen.press("Left")
        self.screen.press("Left")
        self.expect_screen(self.screen, self.views[4])

    def test_focus_and_cone_go_to_the_server(self):
        self.screen.press("Up")
        further = self.server.displays.get(timeout=PATIENCE_S).quilt
        self.assertAlmostEqual(further.focal_distance_m, 2.0 * 1.05)
        self.assertEqual(further.preset, self.asked.quilt.preset)
        self.screen.press("bracketleft")
        narrower = self.server.displays.get(timeout=PATIENCE_S).quilt
        self.assertAlmostEqual(narrower.view_cone_rad, 0.7 / 1.05)
        self.assertAlmostEqual(narrower.focal_distance_m, 2.0 * 1.05)

    def test_modes_follow_one_another_without_those_that_need_a_panel(self):
        self.screen.press("m")
        self.expect_screen(self.screen, pair_of(self.views[5], self.views[7]), tolerance=SCALED)
        self.screen.press("m")
        self.screen.press("m")
        self.expect_screen(self.screen, self.views[5])

    def test_statistics_stand_in_the_corner_until_they_are_sent_away(self):
        self.screen.press("i")
        corner = numpy.s_[16:60, 16:120]

        def is_written():
            seen = self.screen.picture()[corner]
            return (seen == 0).all(axis=2).mean() > 0.5 and (seen == 255).all(axis=2).any()
        self.wait_for(is_written, "white letters on black")
        self.screen.press("i")
        self.expect_screen(self.screen, self.views[5])

    def test_escape_ends_it(self):
        self.screen.press("Escape")
        self.assertEqual(self.show.exit_code(), 0)


class Times(ShowTest):
    def test_an_atlas_waits_for_its_time_and_is_reported_after_it(self):
        view = paint_views(1, *SIZE_PX)[0]
        at_ns = time.time_ns() + 1_500_000_000
        screen = self.start_screen(SIZE_PX)
        server = self.start_server(
            lambda asked: Atlas(view.astype(numpy.uint8), present_at_ns=at_ns))
        self.start_show(screen, server)
        report = server.presented.get(timeout=PATIENCE_S)
        self.assertEqual(report.sequence, 1)
        self.assertGreaterEqual(report.presented_time_ns, at_ns)

    def test_a_server_that_comes_back_is_shown_again(self):
        views = paint_views(2, *SIZE_PX)
        screen = self.start_screen(SIZE_PX)
        first = self.start_server(lambda asked: Atlas(views[0].astype(numpy.uint8)))
        show = self.start_show(screen, first)
        self.expect_screen(screen, views[0])
        first.stop()
        self.wait_for(lambda: "trying again" in show.said(), "a word about the lost server")
        self.expect_screen(screen, views[0])
        self.start_server(lambda asked: Atlas(views[1].astype(numpy.uint8)), address=first.address)
        self.expect_screen(screen, views[1])


class Refusals(ShowTest):
    def expect_refusal(self, screen, exit_code, sentences, *arguments):
        show = self.start_show(screen, None, *arguments)
        self.assertEqual(show.exit_code(), exit_code)
        for sentence in sentences:
            self.assertIn(sentence, show.said())
        self.assertEqual(show.said().count("viewloom: "), 1, show.said())

    def test_a_monitor_that_is_not_there(self):
        self.expect_refusal(self.start_screen(SIZE_PX), 2,
                            ["--monitor 3: there is no such monitor; there are 0: ", "(320x200)"],
                            "--monitor", 3)

    def test_a_panel_that_no_monitor_is(self):
        file = self.calibration_file(PORTRAIT)
        screen = self.start_screen(SIZE_PX)
        self.expect_refusal(screen, 2, ["no monitor has the 1536x2048 px of the calibrated panel",
                                        "(320x200)", "--windowed"], "--calibration", file)
        self.expect_refusal(screen, 2, ["the window has 320x200 px and the calibrated panel "
                                        "1536x2048", "--monitor"],
                            "--calibration", file, "--monitor", 0)

    def test_broken_calibrations(self):
        screen = self.start_screen(SIZE_PX)
        flat = json.dumps(dict(SMALL, pitch={"value": 0}))
        for text, sentence in ((flat, "pitch: is 0"), ("{", "is no JSON"), ("", "is no JSON")):
            file = self.calibration_file(text)
            self.expect_refusal(screen, 2, [f"{file}: ", sentence, "copy LKG_calibration"],
                                "--calibration", file)
        self.expect_refusal(screen, 2, ["gone.json: no such file"], "--calibration", "gone.json")

    def test_no_screen(self):
        self.expect_refusal(None, 1, ["there is no screen to show on", "set DISPLAY"])
        bare = self.start_show(None, None)
        self.assertEqual(bare.exit_code(), 1)
        self.assertEqual(bare.said().count("\n"), 1, "only viewloom speaks")


if __name__ == "__main__":
    ShowTest.viewloom = VIEWLOOM
    unittest.main(verbosity=2)
