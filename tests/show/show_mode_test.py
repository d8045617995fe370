# SPDX-License-Identifier: Apache-2.0
"""`viewloom show` on a panel, told no mode: it asks the server what it traces on."""

import sys
import unittest

VIEWLOOM, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import numpy

from fake_displays import Atlas
from known_pictures import SMALL, paint_views, quilt_of
from reference_weave import woven
from show_case import ShowTest

SIZE_PX = (320, 200)
PATIENCE_S = 120


class SuitedMode(ShowTest):
    def setUp(self):
        self.views = paint_views(12, *SIZE_PX)
        self.native = numpy.random.default_rng(3).integers(0, 256, (200, 320, 3), numpy.uint8)
        self.screen = self.start_screen(SIZE_PX)

    def answer(self, asked):
        return Atlas(self.native) if asked.HasField("lenticular") else quilt_of(self.views, 4)

    def show_on(self, server, *arguments):
        return self.start_show(self.screen, server, "--calibration", self.calibration_file(SMALL),
                               "--between-views", "nearest", *arguments)

    def expect_native(self, server):
        self.expect_screen(self.screen, self.native.astype(float))
        self.assertTrue(server.displays.get(timeout=PATIENCE_S).HasField("lenticular"))

    def expect_woven(self, server):
        self.expect_screen(self.screen, *woven(SMALL, self.views, False))
        self.assertTrue(server.displays.get(timeout=PATIENCE_S).HasField("quilt"))

    def test_quilts_of_a_server_on_a_cpu_are_woven_here(self):
        server = self.start_server(self.answer, traces_on_cpu=True)
        show = self.show_on(server)
        self.expect_woven(server)
        self.assertIn("mode weave: the server renders on a CPU (a device of the test)", show.said())
        self.assertTrue(server.displays.empty())

    def test_a_server_on_a_gpu_interlaces(self):
        server = self.start_server(self.answer, traces_on_cpu=False)
        show = self.show_on(server)
        self.expect_native(server)
        self.assertIn("mode native: the server interlaces, on a device of the test", show.said())

    def test_a_server_that_does_not_say_interlaces(self):
        server = self.start_server(self.answer)
        show = self.show_on(server)
        self.expect_native(server)
        self.assertIn("does not say what it renders on", show.said())

    def test_what_is_said_is_done(self):
        server = self.start_server(self.answer, traces_on_cpu=True)
        show = self.show_on(server, "--mode", "native")
        self.expect_native(server)
        self.assertNotIn("renders on a CPU", show.said())

    def test_options_of_quilts_are_said_to_be_without_effect(self):
        server = self.start_server(self.answer, traces_on_cpu=False)
        show = self.show_on(server, "--preset", "go_p", "--columns", 5)
        self.expect_native(server)
        self.assertIn("mode native does not use --preset, --columns: ", show.said())

    def test_a_server_that_comes_later_is_asked_then(self):
        gone = self.start_server(self.answer, traces_on_cpu=True)
        gone.stop()
        show = self.show_on(gone)
        self.wait_for(lambda: "trying again" in show.said(), "a word about the server")
        server = self.start_server(self.answer, traces_on_cpu=True, address=gone.address)
        self.expect_woven(server)

    def test_a_key_chooses_and_another_ends_it_before_the_server_is_there(self):
        gone = self.start_server(self.answer, traces_on_cpu=False)
        gone.stop()
        show = self.show_on(gone)
        self.wait_for(lambda: "trying again" in show.said(), "a word about the server")
        self.screen.press("m")
        server = self.start_server(self.answer, traces_on_cpu=False, address=gone.address)
        self.expect_woven(server)
        self.assertNotIn("mode native", show.said())
        self.screen.press("Escape")
        self.assertEqual(show.exit_code(), 0)


if __name__ == "__main__":
    ShowTest.viewloom = VIEWLOOM
    unittest.main(verbosity=2)
