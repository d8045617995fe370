# SPDX-License-Identifier: Apache-2.0
"""Atlases of H.264 in a browser: decoded by the page's modules, and compared with the views that
OpenH264 coded. Argument: the program code_stack."""
import base64
import json
import os
import sys
import unittest

import numpy as np

import coded_atlases
from browser import CHROMIUM, Browser

WAYS = ("planes", "texImage2D")
PATCHES = [(0, 0, 0), (255, 255, 255), (128, 128, 128), (255, 0, 0), (0, 255, 0), (0, 0, 255),
           (255, 255, 0), (0, 255, 255), (255, 0, 255), (200, 120, 80), (17, 60, 140),
           (90, 160, 40), (1, 2, 3)]
PATCH_WIDTH, PATCH_HEIGHT = 48, 32  # whole macroblocks: no block mixes two patches
# A last row that is not full, and padding: nothing that hides a swapped axis.
GRIDS = [dict(columns=5, rows=3), dict(columns=5, rows=3, order="TOP_LEFT", padding_right=3,
                                       padding_top=7)]


def flat_views():
    return np.stack([np.full((PATCH_HEIGHT, PATCH_WIDTH, 3), patch, np.uint8)
                     for patch in PATCHES])


def textured_views(count=13, width=97, height=63):
    """Smooth waves that move from view to view, of odd sizes."""
    y, x = np.mgrid[:height, :width].astype(float)
    views = []
    for view in range(count):
        waves = [128 + 90 * np.sin((x - 2 * view) / 9 + channel) * np.cos(y / (11 + channel))
                 for channel in range(3)]
        views.append(np.rint(np.stack(waves, axis=-1)).astype(np.uint8))
    return np.stack(views)


def psnr(a, b):
    return 10 * np.log10(255 ** 2 / np.mean((a.astype(float) - b) ** 2))


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class Video(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = coded_atlases.PageFiles({})
        cls.addClassCleanup(cls.files.close)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.files.contents.clear()
        self.browser.open(self.files.url + "video_harness.html")
        self.browser.wait_for("window.isReady")

    def code(self, name, views, qp=20, **grid):
        """Its layout. The message is at the path `name`."""
        layout = coded_atlases.layout_of(views=views, **(grid or dict(columns=5, rows=3)))
        ((video, units),) = coded_atlases.code_stacks(PROGRAM, [views], qp)
        self.files.contents[name] = coded_atlases.video_message(layout, video, units)
        self.units, self.video = units, video
        return layout

    def pixels(self, expression, width, height):
        data = base64.b64decode(self.browser.evaluate(expression))
        return np.frombuffer(data, np.uint8).reshape(height, width, 4)[..., :3]

    def picture(self, name, way, layout):
        size = layout["size"]
        return self.pixels(f"picture({name!r}, {way!r})", size["width"], size["height"])

    def test_colours_of_flat_patches_are_right(self):
        views = flat_views()
        for index, grid in enumerate(GRIDS):
            name = f"flat{index}"
            layout = self.code(name, views, **grid)
            quilt = coded_atlases.quilt_of(views, layout).astype(float)
            for way in WAYS:
                shown = self.picture(name, way, layout)
                means = []
                for view, patch in enumerate(PATCHES):
                    x, y = coded_atlases.tile_origin(layout, view)
                    errors = (shown - quilt)[y:y + PATCH_HEIGHT, x:x + PATCH_WIDTH]
                    # Colour of frames that the browser converts reaches over the edge of a view.
                    inner = errors if way == "planes" else errors[1:-1, 1:-1]
                    means.append(inner.mean(axis=(0, 1)))
                    # Coding errs by half a code, and browsers convert with few bits.
                    self.assertLessEqual(np.abs(means[-1]).max(), 1.5 if way == "planes" else 2.5,
                                         f"{way}, {patch}: {means[-1]}")
                self.assertLessEqual(np.abs(np.mean(means, axis=0)).max(), 1, way)

    def test_views_stand_in_their_tiles_and_nothing_beside_them(self):
        views = textured_views()
        for index, grid in enumerate(GRIDS):
            name = f"textured{index}"
            layout = self.code(name, views, **grid)
            quilt = coded_atlases.quilt_of(views, layout)
            for way in WAYS:
                shown = self.picture(name, way, layout)
                self.assertGreater(psnr(shown, quilt), 36, (way, grid))
                self.assertLess(shown[quilt.max(axis=-1) == 0].max(initial=0), 3)

    def test_a_part_is_scaled_as_a_bitmap_is(self):
        layout = self.code("textured", textured_views())
        width, height = layout["size"]["width"], layout["size"]["height"]
        tile = layout["tile_size"]
        for source, size in (((0, 0, width, height), (width // 4, height // 4)),
                             ((tile["width"] + 0.5, 0.5, tile["width"] - 1, tile["height"] - 1),
                              (3 * tile["width"], 3 * tile["height"]))):
            by_way = [self.pixels(f"part('textured', {way!r}, {json.dumps(source)}, {size[0]}, "
                                  f"{size[1]})", *size) for way in WAYS]
            for other in by_way[1:]:
                # Planes are made smaller by whole blocks of px, within each view.
                self.assertGreater(psnr(by_way[0], other), 27, f"{source} to {size}")

    def test_a_panel_is_woven_as_of_a_bitmap(self):
        self.code("textured", textured_views())
        by_way = [self.pixels(f"woven('textured', {way!r}, 300, 200)", 300, 200) for way in WAYS]
        self.assertGreater(by_way[0].std(), 20)
        for other in by_way[1:]:
            self.assertGreater(psnr(by_way[0], other), 36)

    def test_every_frame_is_closed(self):
        self.code("textured", textured_views())
        whole = self.files.contents["textured"]
        self.files.contents["spoilt"] = whole[:-200] + bytes(200)
        kept = self.browser.evaluate("repeat(['textured', 'textured', 'spoilt'], 60)")
        self.assertEqual(kept["frames"], kept["closed"])
        self.assertGreaterEqual(kept["frames"], 40 * self.video["picture_count"])
        self.assertIn(kept["upload"], WAYS)
        whole_only = self.browser.evaluate("repeat(['textured'], 20)")
        self.assertEqual(whole_only["errors"], [])
        self.assertEqual(whole_only["frames"], whole_only["closed"])

    def test_a_decoder_that_hangs_is_given_up(self):
        self.code("textured", textured_views())
        self.assertEqual(self.browser.evaluate("hang('textured')"),
                         "the decoder gives no picture")

    def test_of_atlases_that_come_too_fast_the_newest_is_decoded(self):
        layout = self.code("0", textured_views())
        for sequence in range(5):
            self.files.contents[str(sequence)] = coded_atlases.video_message(
                layout, self.video, self.units, sequence=sequence)
        burst = self.browser.evaluate("burst(['0', '1', '2', '3', '4'])")
        self.assertEqual(burst, {"shown": [0, None, None, None, 4], "failures": []})

    def code_chain(self, count):
        """Messages of chained atlases, each moved against the one before: 1, 2, ... """
        views = [np.roll(textured_views(), 3 * number, axis=2) for number in range(count)]
        coded = coded_atlases.code_stacks(PROGRAM, views, 20, chained=True)
        layout = coded_atlases.layout_of(5, 3, views[0])
        for number, (video, units) in enumerate(coded, 1):
            self.files.contents[str(number)] = coded_atlases.video_message(
                layout, video, units, sequence=number, reference_sequence=number - 1,
                is_backward=number % 2 == 0)
        return layout, views

    def test_chained_atlases_are_decoded_in_order(self):
        layout, views = self.code_chain(4)
        for number in range(1, 5):
            picture = self.browser.evaluate(f"followed('{number}')")
            decoded = np.frombuffer(base64.b64decode(picture), np.uint8).reshape(
                layout["size"]["height"], layout["size"]["width"], 4)[..., :3]
            quilt = coded_atlases.quilt_of(views[number - 1], layout)
            self.assertGreater(psnr(decoded, quilt), 30, number)  # edges of rolled views

    def test_all_of_a_chain_are_decoded_and_the_newest_is_shown(self):
        self.code_chain(5)
        burst = self.browser.evaluate("burst(['1', '2', '3', '4', '5'])")
        self.assertEqual(burst, {"shown": [1, None, None, None, 5], "failures": []})
        again = self.browser.evaluate("burst(['1', '2'])")
        self.assertEqual(again["shown"], [1, 2], "one that needs no other begins anew")

    def test_a_chain_with_a_missing_atlas_is_told(self):
        self.code_chain(3)
        burst = self.browser.evaluate("burst(['1'])")
        self.assertEqual(burst["shown"], [1])
        broken = self.browser.evaluate("burst(['3'])")
        self.assertEqual(broken["shown"], [None])
        self.assertIn("refers to atlas 2", broken["failures"][-1])
        self.assertEqual(self.browser.evaluate("burst(['1'])")["shown"], [1])

    def test_what_cannot_be_decoded_is_told_and_the_next_one_is_shown(self):
        layout = self.code("good", textured_views())
        other_size = {**self.video, "picture_size": {"width": 640, "height": 480}}
        bad = {
            "noise": [bytes([7] * 500)] * len(self.units),
            "no_reference": [self.units[1]] * len(self.units),
            "too_few": self.units[:-1],
            "another_size": self.units,
            "no_codec": self.units,
        }
        for name, units in bad.items():
            video = {"another_size": other_size,
                     "no_codec": {**self.video, "codec_string": "avc1.FFFFFF"}}.get(
                         name, self.video)
            self.files.contents[name] = coded_atlases.video_message(layout, video, units)
            before = len(self.browser.evaluate("burst([])")["failures"])
            burst = self.browser.evaluate(f"burst([{name!r}])")
            self.assertEqual(burst["shown"], [None], name)
            self.assertEqual(len(burst["failures"]), before + 1, name)
            self.assertGreater(len(burst["failures"][-1]), 10, name)
            self.assertEqual(self.browser.evaluate("burst(['good'])")["shown"], [1], name)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop()
    unittest.main()
