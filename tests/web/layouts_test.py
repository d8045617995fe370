# SPDX-License-Identifier: Apache-2.0
"""Every mode of the page in windows of a desktop and of a phone that stands and lies.

Rules hold for all of them: nothing lies over anything else, nothing reaches out of the window, the
picture fills the width or the height, texts can be read, and what is switched off says why. Beside
them, layouts.txt keeps where the parts of the page stand, and how light each tenth of the window
is: text, since a change of it can be read and reviewed. VIEWLOOM_LAYOUTS=keep writes the file anew;
VIEWLOOM_SCREENSHOTS names a folder for the pictures themselves."""
import os
import sys
import unittest

from PIL import Image

from page_checks import LOW_CONTRASTS, OUTSIDE, OVERLAPS, UNREASONED
from page_test import LIVE, PageTest, keep, picture_box
from web_client import Server

MODES = ("look", "single", "quilt", "panel", "eye", "rgbd")
SIZES = ((1440, 900), (390, 844), (844, 390))
BASELINE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "layouts.txt")
# Fonts differ from one machine to another by so much.
PLACE_TOLERANCE_PX = 16
CELLS = (10, 6)          # of a window, for how light it is
LIGHT_TOLERANCE = 3      # of 15, in any cell
# Parts whose places are kept. What is not shown has none.
PLACES = """Object.fromEntries(
    ['header', '#modes', '#picture', '.tools:not([hidden])', 'aside', '#diagnostics']
        .map(name => [name.split(':')[0], document.querySelector(name)])
        .filter(([, part]) => part)
        .map(([name, part]) => {
          const {x, y, width, height} = part.getBoundingClientRect();
          return [name, [x, y, width, height].map(Math.round)];
        }))"""
HEAD = """# Mode, window, part; then x, y, width and height of the part in CSS px, or how light
# the window is, cell by cell. Written by layouts_test.py.
"""
STILL = "document.getElementById('brief').textContent === 'still'"


def lightness(image):
    """A hexadecimal digit for each cell, row by row."""
    cells = image.convert("L").resize(CELLS, Image.Resampling.BOX)
    return "".join(f"{level >> 4:x}" for level in cells.tobytes())


def read_baseline():
    """{(mode, size, part): words}"""
    with open(BASELINE, encoding="utf-8") as lines:
        rows = [line.split() for line in lines if not line.startswith("#")]
    return {tuple(row[:3]): row[3:] for row in rows}


class Layouts(PageTest):
    """One test for each window; the tests look at all modes."""

    def setUp(self):
        self.server = Server(PROGRAM)  # its picture stands
        self.addCleanup(lambda: self.server.__exit__())
        self.start_browser()
        self.dress("dark")

    def dress(self, scheme):
        self.browser.call("Emulation.setEmulatedMedia",
                          features=[{"name": "prefers-color-scheme", "value": scheme},
                                    {"name": "prefers-reduced-motion", "value": "reduce"}])

    def show(self, mode, width, height):
        is_phone = min(width, height) < 500
        self.browser.resize(width, height, mobile=is_phone)
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=is_phone)
        self.browser.open(f"{self.server.url}?stream=painted&detail=0.25&mode={mode}")
        self.browser.wait_for(f"{LIVE} && {STILL}")

    def measure(self, width, height):
        """{(mode, size, part): words} of this window; checks the rules on the way."""
        size = f"{width}x{height}"
        measured = {}
        for mode in MODES:
            with self.subTest(f"{mode} {size}"):
                self.show(mode, width, height)
                shot = self.browser.screenshot()
                keep(shot, f"layout_{mode}_{size}")
                for fault in (OVERLAPS, OUTSIDE, LOW_CONTRASTS, UNREASONED):
                    self.assertEqual(self.browser.evaluate(fault), [])
                self.assert_picture_fills(shot, mode)
                self.assertEqual(self.browser.messages + self.browser.errors, [])
                for part, box in self.browser.evaluate(PLACES).items():
                    measured[mode, size, part] = [str(number) for number in box]
                measured[mode, size, "light"] = [lightness(shot)]
        return measured

    def assert_picture_fills(self, shot, mode):
        """Less the margin of 2.5 % that large windows have."""
        if mode in ("panel", "eye"):
            return  # the one says what it needs; the other shows as much of a panel as fits
        left, top, width, height = (int(side) for side in self.canvas())
        self.assertLessEqual(top, shot.height / 2)
        place = shot.crop((left, top, min(left + width, shot.width),
                           min(top + height, shot.height)))
        x, y, right, bottom = picture_box(place)
        shares = ((right - x) / place.width, (bottom - y) / place.height)
        self.assertGreaterEqual(max(shares), 0.94, shares)

    def assert_as_kept(self, measured):
        kept = read_baseline()
        for key, words in measured.items():
            with self.subTest(" ".join(key)):
                self.assertIn(key, kept)
                if key[2] == "light":
                    gaps = [abs(int(a, 16) - int(b, 16)) for a, b in zip(words[0], kept[key][0])]
                    self.assertLessEqual(max(gaps), LIGHT_TOLERANCE, f"{words[0]}, {kept[key][0]}")
                else:
                    gaps = [abs(int(a) - int(b)) for a, b in zip(words, kept[key])]
                    self.assertLessEqual(max(gaps), PLACE_TOLERANCE_PX, f"{words}, {kept[key]}")

    def check(self, width, height):
        measured = self.measure(width, height)
        if os.environ.get("VIEWLOOM_LAYOUTS") == "keep":
            keep_baseline(measured)
        self.assert_as_kept(measured)

    def test_a_desktop(self):
        self.check(*SIZES[0])

    def test_a_phone_that_stands(self):
        self.check(*SIZES[1])

    def test_a_phone_that_lies(self):
        self.check(*SIZES[2])

    def test_the_same_texts_can_be_read_on_a_light_page(self):
        self.dress("light")
        for mode in MODES:
            self.show(mode, *SIZES[0])
            keep(self.browser.screenshot(), f"light_{mode}")
            self.browser.evaluate("document.querySelectorAll('details').forEach(d => "
                                  "{ d.open = true; })")
            self.assertEqual(self.browser.evaluate(LOW_CONTRASTS), [], mode)


def keep_baseline(measured):
    kept = read_baseline() if os.path.exists(BASELINE) else {}
    kept.update(measured)
    with open(BASELINE, "w", encoding="utf-8") as file:
        file.write(HEAD)
        for key in sorted(kept):
            file.write(" ".join((*key, *kept[key])) + "\n")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], *([] if sys.argv[1:] else ["Layouts"])])
