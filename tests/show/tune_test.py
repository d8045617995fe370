# SPDX-License-Identifier: Apache-2.0
"""`viewloom show --tune`: its pattern px by px, what keys make of it, the file that is written."""

import json
import pathlib
import sys
import tempfile
import unittest

VIEWLOOM, STUBS = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, STUBS)

import numpy

from known_pictures import SMALL
from reference_weave import BORDER, value, view_coordinates
from show_case import ShowTest

PANEL = dict(SMALL, screenW=800, screenH=400)
# The values are written above this row.
FIRST_ROW = 240
BLUE, RED = (0, 51, 255), (255, 51, 0)


def pattern(calibration):
    """float64[height][width][3], and what it may be as well where a subpixel lies on a border."""
    coordinates = view_coordinates(calibration)
    pictures = []
    for moved in (-BORDER, BORDER):
        at = (coordinates + moved) % 1
        side = numpy.where(at < 0.5, numpy.array(BLUE), numpy.array(RED))
        pictures.append(numpy.where(numpy.abs(at - 0.5) < 0.0625, 255, side).astype(float))
    return pictures


class Tuning(ShowTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.screen = self.start_screen((800, 400))

    def start_tuning(self, out):
        return self.start_show(self.screen, None, "--tune", "--out", out,
                               "--calibration", self.calibration_file(PANEL))

    def expect_pattern(self, calibration):
        shown, other = (picture[FIRST_ROW:] for picture in pattern(calibration))
        self.assertLess((shown != other).mean(), 2e-3)
        self.expect_screen(self.screen, shown, other, first_row=FIRST_ROW)

    def test_keys_move_the_pattern_and_enter_writes_the_file(self):
        out = self.folder / "visual.json"
        show = self.start_tuning(out)
        self.expect_pattern(PANEL)
        tuned = dict(PANEL, pitch=value(PANEL, "pitch") + 0.005,
                     slope=value(PANEL, "slope") - 0.001, center=value(PANEL, "center") + 0.002)
        for key in ("shift+Up", "Left", "bracketright"):
            self.screen.press(key)
        self.expect_pattern(tuned)
        self.screen.press("Return")
        self.assertEqual(show.exit_code(), 0)
        self.assertIn(f"wrote {out}", show.said())
        written = json.loads(out.read_text())
        for key in ("pitch", "slope", "center", "DPI", "screenW", "CellPatternMode"):
            self.assertAlmostEqual(value(written, key), value(tuned, key), places=12, msg=key)
        self.assertEqual(written["subpixelCells"], PANEL["subpixelCells"])
        self.assertEqual(list(self.folder.iterdir()), [out])

    def test_escape_writes_nothing(self):
        show = self.start_tuning(self.folder / "visual.json")
        self.expect_pattern(PANEL)
        self.screen.press("Escape")
        self.assertEqual(show.exit_code(), 0)
        self.assertIn("nothing was written", show.said())
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_file_that_cannot_be_written_loses_nothing(self):
        folder = self.folder / "away"
        folder.mkdir()
        show = self.start_tuning(folder / "visual.json")
        self.expect_pattern(PANEL)
        folder.rmdir()
        self.screen.press("s")
        self.wait_for(lambda: "nothing is lost yet" in show.said(), "a word")
        folder.mkdir()
        self.screen.press("s")
        self.assertEqual(show.exit_code(), 0)
        self.assertTrue((folder / "visual.json").exists())


if __name__ == "__main__":
    ShowTest.viewloom = VIEWLOOM
    unittest.main(verbosity=2)
