# SPDX-License-Identifier: Apache-2.0
"""Panel mode and the lens simulator in a real browser, read back px by px. Each view of the painted
server is one grey, so that the grey of a subpixel says which view it shows.
Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS, when that is set."""
import json
import sys
import unittest

import numpy as np

from browser import Browser
from page_test import PageTest, keep
from panel_formula import CELLS, PORTRAIT, edited, view_coordinates
from web_client import Server, asked, quilt

VIEW_COUNT = 48
# Tiles of 80x80 px are whole JPEG blocks: no grey reaches into another.
QUILT = "?" + asked(quilt(8, 6, 640, 480, aspect=0.75),
                    {"jpeg_quality": 100, "chroma": "CHROMA_SUBSAMPLING_444"})
SMALL = {"screenW": 333, "screenH": 444, "DPI": 80}
SERIAL = edited(PORTRAIT, **SMALL)
# Lenses are known to 2^-24 and summed over 333 + 444 px; a view is 1/48 of one.
BOUNDARY = 1e-5 * VIEW_COUNT


class Weave(PageTest):
    view_count = VIEW_COUNT

    def setUp(self):
        self.server = Server(PROGRAM, "--flat", 1)
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()

    def start_scaled_browser(self, scale):
        self.browser = Browser(native_scale=scale)
        self.addCleanup(self.browser.close)
        self.browser.resize(1280, 800, scale=0)

    def choose_file(self, calibration, name="visual.json"):
        """As somebody who chooses the file, or drops it there."""
        text = calibration if isinstance(calibration, str) else json.dumps(calibration)
        self.browser.evaluate(
            f"(file => {{ const drop = new DataTransfer(); drop.items.add(file);"
            f" document.dispatchEvent(new DragEvent('drop', {{dataTransfer: drop}})); }})"
            f"(new File([{json.dumps(text)}], {name!r}))")

    def state(self):
        return self.browser.evaluate("document.getElementById('panel-state').textContent")

    def wait_for_state(self, words):
        self.browser.wait_for(
            f"document.getElementById('panel-state').textContent.includes({words!r})")

    def show_on_panel(self, calibration, scale=1):
        """Full screen on a monitor as large as the panel."""
        width, height = calibration["screenW"]["value"], calibration["screenH"]["value"]
        self.open(QUILT + "&mode=panel")
        self.choose_file(calibration)
        self.wait_for_state("press")
        self.browser.click("#fullscreen")
        self.browser.resize(width // scale, height // scale, scale=0)
        self.wait_for_state("px by px")

    def compare(self, calibration, picture):
        """Every subpixel shows its view; at a view's edge it may be the one beyond."""
        shown = np.rint(np.asarray(picture, float) / 255 * (VIEW_COUNT - 1)).astype(int)
        exact = view_coordinates(calibration) * VIEW_COUNT
        expected = np.minimum(np.floor(exact), VIEW_COUNT - 1).astype(int)
        wrong = shown != expected
        from_edge = np.abs(exact - np.rint(exact))
        self.assertEqual(np.count_nonzero(wrong & (from_edge > BOUNDARY)), 0,
                         f"{np.count_nonzero(wrong)} of {wrong.size} differ")
        self.assertLess(np.count_nonzero(wrong), 1e-3 * wrong.size)

    def woven(self, calibration, scale=1):
        self.show_on_panel(calibration, scale)
        picture = self.browser.screenshot()
        self.assertEqual(picture.size, (calibration["screenW"]["value"],
                                        calibration["screenH"]["value"]))
        return picture

    def test_weaves_a_portrait_px_by_px_on_its_own_monitor(self):
        picture = self.woven(PORTRAIT)
        keep(picture, "woven")
        self.compare(PORTRAIT, picture)
        with self.assertRaises(AssertionError):  # a quarter of a view beside it
            self.compare(edited(PORTRAIT, center=PORTRAIT["center"]["value"] + 0.005), picture)

    def test_weaves_by_device_px_where_the_page_is_scaled(self):
        self.start_scaled_browser(2)
        calibration = edited(PORTRAIT, screenW=332, screenH=444, DPI=80)
        self.compare(calibration, self.woven(calibration, scale=2))

    def test_weaves_every_pattern_of_cells(self):
        for mode in range(5):
            for count in (1, 2, 4):
                with self.subTest(mode=mode, count=count):
                    calibration = edited(SERIAL, CellPatternMode=mode,
                                         subpixelCells=CELLS[:count])
                    self.compare(calibration, self.read_woven(calibration))

    def test_weaves_flipped_inverted_and_leaning_panels(self):
        for changes in ({"flipImageX": 1}, {"flipSubp": 1}, {"invView": 0}, {"slope": 5.04},
                        {"center": -3.7}, {"flipImageX": 1, "flipSubp": 1, "invView": 0},
                        {"flipSubp": 1, "subpixelCells": CELLS[:2], "CellPatternMode": 2}):
            with self.subTest(changes):
                calibration = edited(SERIAL, **changes)
                self.compare(calibration, self.read_woven(calibration))

    def read_woven(self, calibration):
        """The canvas alone, from the page's own weaver, without a monitor of that size."""
        if not self.browser.evaluate("document.documentElement.dataset.state === 'live'"):
            self.open(QUILT + "&mode=panel")
        size = (calibration["screenW"]["value"], calibration["screenH"]["value"])
        self.choose_file(calibration)
        self.wait_for_state("press")
        left, top = self.browser.evaluate(
            "(r => [r.x, r.y])(document.getElementById('woven').getBoundingClientRect())")
        self.browser.evaluate("new Promise(done => requestAnimationFrame(() => "
                              "requestAnimationFrame(done)))")
        return self.browser.screenshot().crop((left, top, left + size[0], top + size[1]))

    def test_says_in_one_sentence_what_keeps_the_panel_from_its_px(self):
        self.open(QUILT + "&mode=panel")
        self.assertIn("visual.json", self.state())
        for text, words in (("[1, 2", "is no JSON"), ("[]", "accepted is one JSON object"),
                            ("{}", "pitch: is missing"),
                            (edited(SERIAL, slope=0), "slope: is 0"),
                            (edited(SERIAL, screenW=0.5), "screenW: is 0.5"),
                            (edited(SERIAL, CellPatternMode=5), "CellPatternMode: is 5"),
                            (edited(SERIAL, pitch=9999), "lenses across"),
                            (edited(SERIAL, subpixelCells=[{}]), "subpixelCells[0].ROffsetX"),
                            (edited(SERIAL, subpixelCells=CELLS + CELLS), "up to 4 cells")):
            with self.subTest(words):
                self.choose_file(text)
                self.wait_for_state(words)
        self.choose_file(SERIAL)
        self.wait_for_state("press")
        self.browser.click("#fullscreen")
        self.browser.resize(444, 333)
        self.wait_for_state("monitor is turned")
        self.browser.resize(300, 400)
        self.wait_for_state("shows 300 × 400 px, the panel has 333 × 444")
        self.browser.resize(333, 444)
        self.wait_for_state("px by px")

    def test_keeps_the_calibration_for_the_next_visit(self):
        self.open(QUILT + "&mode=panel")
        self.choose_file(SERIAL)
        self.wait_for_state("press")
        self.open(QUILT + "&mode=panel")
        self.wait_for_state("press")

    def seen_grey(self, share):
        """Median over the middle of the picture, as a share of all views."""
        left, top, width, height = self.browser.evaluate(
            "(r => [r.x, r.y, r.width, r.height])"
            "(document.getElementById('woven').getBoundingClientRect())")
        self.browser.mouse(left + (0.5 + (share - 0.5) / 1.5) * width, top + height / 2)
        self.browser.evaluate("new Promise(done => requestAnimationFrame(() => "
                              "requestAnimationFrame(done)))")
        shot = np.asarray(self.browser.screenshot().crop(
            (left + width * 0.45, top + height * 0.4, left + width * 0.55, top + height * 0.6)))
        return np.median(shot) / 255, shot

    def test_an_eye_sees_the_view_that_is_sent_its_way(self):
        self.open(QUILT + "&mode=eye")
        for share in (0.1, 0.3, 0.5, 0.8):
            grey, shot = self.seen_grey(share)
            self.assertAlmostEqual(grey, share, delta=0.04)
            # One view, and what the lens mixes into it.
            self.assertLess(shot.std() / 255, 0.05)
        keep(self.browser.screenshot(), "eye")
        # Beyond the cone the views come again.
        grey, _ = self.seen_grey(1.2)
        self.assertAlmostEqual(grey, 0.2, delta=0.04)

    def test_a_nearer_eye_sees_other_views_at_the_panel_s_ends(self):
        self.open(QUILT + "&mode=eye")
        self.browser.evaluate("(e => { e.value = 0.5; e.dispatchEvent(new Event('input')); })"
                              "(document.getElementById('eye-distance'))")
        self.seen_grey(0.5)
        left, top, width, height = self.browser.evaluate(
            "(r => [r.x, r.y, r.width, r.height])"
            "(document.getElementById('woven').getBoundingClientRect())")
        picture_width = height * 1536 / 2048
        row = np.asarray(self.browser.screenshot().convert("L"))[int(top + height / 2)]
        middle = left + width / 2
        greys = [np.median(row[int(middle + at * picture_width) - 8:][:16]) / 255
                 for at in (-0.25, 0, 0.25)]
        # From X on the panel an eye half as far sees what goes to -X: 1536 px at 324 DPI are
        # 0.1204 m, the cone of 40 degrees is 0.4760 m wide where the panel's height fills 14.
        step = 0.25 * 0.1204 / 0.4760
        for grey, expected in zip(greys, (0.5 + step, 0.5, 0.5 - step)):
            self.assertAlmostEqual(grey, expected, delta=0.035)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["Weave"])])
