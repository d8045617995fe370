# SPDX-License-Identifier: Apache-2.0
"""`viewloom show` on a screen in memory, px by px against the weave that the formula asks for.

The server is a fake whose atlases are known; the weave is computed in binary64 beside it.
"""

import json
import sys
import unittest

VIEWLOOM, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import grpc
import numpy

from viewloom.v1 import display_pb2 as display

from fake_displays import Atlas
from known_pictures import PORTRAIT, SMALL, THIRD_GENERATION, paint_views, quilt_of
from reference_weave import panel_size_px, woven
from show_case import EXACT, ShowTest

# Codes of 8 bits. Cards blend neighbouring texels with 8 bits; two such views are blended again.
BLENDED = 0.6
SCALED = 1.5
# Where views lie 1e-5 from their border, either neighbour may show: at most this share.
BORDER_SHARE_MAX = 2e-3


class Weaving(ShowTest):
    def expect_weave(self, calibration, views, atlas, between, *more, tolerance=EXACT):
        screen = self.start_screen(panel_size_px(calibration))
        server = self.start_server(lambda asked: atlas)
        self.start_show(screen, server, "--calibration", self.calibration_file(calibration),
                        "--mode", "weave", "--between-views", between, *more)
        server.presented.get(timeout=120)
        shown, other = woven(calibration, views, between == "blend")
        self.assertLess((shown != other).mean(), BORDER_SHARE_MAX)
        self.expect_screen(screen, shown, other, tolerance)
        return server

    def test_a_portrait_shows_the_nearest_view_of_each_subpixel(self):
        views = paint_views(48, 420, 560)
        server = self.expect_weave(PORTRAIT, views, quilt_of(views, 8), "nearest",
                                   tolerance=SCALED)
        asked = server.displays.get(timeout=120).quilt
        self.assertEqual(asked.preset, "portrait")
        self.assertAlmostEqual(asked.view_cone_rad, numpy.deg2rad(40))
        self.assertAlmostEqual(asked.aspect, 1536 / 2048)

    def test_cells_of_the_third_generation_blend_their_two_nearest_views(self):
        views = paint_views(48, 480, 270)
        server = self.expect_weave(THIRD_GENERATION, views, quilt_of(views, 8, 7, 5), "blend",
                                   tolerance=SCALED)
        self.assertEqual(server.displays.get(timeout=120).quilt.preset, "16_gen3_l")

    def test_every_switch_turned_and_views_from_the_top(self):
        views = paint_views(12, 320, 200)
        atlas = quilt_of(views, 4, order=display.TILE_ORDER_TOP_LEFT)
        for between in ("nearest", "blend"):
            self.expect_weave(SMALL, views, atlas, between, "--windowed",
                              tolerance=BLENDED)

    def test_every_pattern_of_cells(self):
        views = paint_views(12, 320, 200)
        for mode in range(5):
            with self.subTest(mode=mode):
                self.expect_weave(dict(SMALL, CellPatternMode=mode), views, quilt_of(views, 4),
                                  "nearest")


class Native(ShowTest):
    def test_what_the_server_interlaces_is_shown_as_it_is(self):
        picture = numpy.random.default_rng(7).integers(0, 256, (200, 320, 3), numpy.uint8)
        screen = self.start_screen((320, 200))
        server = self.start_server(lambda asked: Atlas(picture))
        self.start_show(screen, server, "--calibration", self.calibration_file(SMALL))
        self.expect_screen(screen, picture.astype(float))
        sent = json.loads(server.displays.get(timeout=120).lenticular.calibration_json)
        self.assertEqual(sent["pitch"]["value"], SMALL["pitch"]["value"])
        self.assertEqual(sent["subpixelCells"], SMALL["subpixelCells"])

    def test_quilts_are_woven_where_the_server_does_not_interlace(self):
        views = paint_views(12, 320, 200)
        screen = self.start_screen((320, 200))
        server = self.start_server(lambda asked: grpc.StatusCode.UNIMPLEMENTED
                                   if asked.HasField("lenticular") else quilt_of(views, 4))
        show = self.start_show(screen, server, "--calibration", self.calibration_file(SMALL),
                               "--between-views", "nearest")
        self.expect_screen(screen, *woven(SMALL, views, False))
        self.assertIn("does not interlace", show.said())
        self.assertIn("woven here instead", show.said())


if __name__ == "__main__":
    ShowTest.viewloom = VIEWLOOM
    unittest.main(verbosity=2)
