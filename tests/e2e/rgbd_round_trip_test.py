# SPDX-License-Identifier: Apache-2.0
"""Colour with depth as files: what `viewloom watch --rgbd` writes, and what comes of it when
`viewloom publish --input rgbd` reads it. Arguments: viewloomd, viewloom."""
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zlib

import viewloomd  # takes its argument

import numpy as np
from PIL import Image

CLIENT = sys.argv.pop(1)
WIDTH, HEIGHT = 160, 90
NEAR_M, FAR_M = 1.0, 20.0
RANGE = ["--depth-near", str(NEAR_M), "--depth-far", str(FAR_M)]


def png_16(data):
    """[height][width][3] of a PNG of 16 bits RGB, by the specification: Pillow has 8 bits."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
            assert list(body[8:]) == [16, 2, 0, 0, 0], list(body[8:])
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    rows = zlib.decompress(packed)
    stride = 6 * width
    before = np.zeros(stride, int)
    picture = np.zeros((height, stride), int)
    for y in range(height):
        row = np.frombuffer(rows, np.uint8, stride + 1, y * (stride + 1)).astype(int)
        kind, line = row[0], row[1:]
        for x in range(stride):
            left = line[x - 6] if x >= 6 else 0
            corner = before[x - 6] if x >= 6 else 0
            up = before[x]
            estimate = left + up - corner
            distances = [abs(estimate - value) for value in (left, up, corner)]
            paeth = (left, up, corner)[distances.index(min(distances))]
            line[x] = (line[x] + (0, left, up, (left + up) // 2, paeth)[kind]) % 256
        picture[y] = before = line
    return picture.reshape(height, width, 3, 2) @ np.array([256, 1])


class RgbdRoundTrip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = viewloomd.Viewloomd()
        cls.addClassCleanup(cls.server.stop)
        cls.run_client("publish", "--synthetic", "--stream", "scene", "--size",
                       f"{WIDTH}x{HEIGHT}", "--seconds", "0.1", "--quiet")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    @classmethod
    def run_client(cls, *arguments):
        return subprocess.run([CLIENT, "--server", cls.server.address, *arguments], check=True,
                              timeout=viewloomd.PATIENCE_S, capture_output=True, text=True)

    def watch(self, stream, *arguments):
        """The one file that is written."""
        out = self.folder / f"out{len(list(self.folder.iterdir()))}"
        self.run_client("watch", stream, "--rgbd", f"{WIDTH}x{HEIGHT}", "--count", "1", "--quiet",
                        "--out", str(out), *arguments)
        (file,) = out.iterdir()
        return file

    def published_again(self, file, *arguments):
        stream = f"again{abs(hash(file))}"
        self.run_client("publish", str(file), "--input", "rgbd", *RANGE, "--stream", stream,
                        "--fov", "40", "--quiet", *arguments)
        return stream

    def test_8_bits_come_back_within_a_code(self):
        for side in ("right", "left", "top", "bottom"):
            placed = ["--depth-side", side]
            file = self.watch("scene", *RANGE, *placed, "--lossless", "--format", "png")
            self.assertTrue(file.name.endswith("_rgbd.png"), file.name)
            sent = np.asarray(Image.open(file)).astype(int)
            tall = side in ("top", "bottom")
            self.assertEqual(sent.shape, (HEIGHT * (1 + tall), WIDTH * (2 - tall), 3))
            stream = self.published_again(file, *placed)
            again = np.asarray(Image.open(
                self.watch(stream, *RANGE, *placed, "--lossless", "--format", "png"))).astype(int)
            self.assertLessEqual(np.abs(again - sent).max(), 1, side)
            self.assertGreater(sent[..., 0].std(), 10)

    def test_16_bits_come_back_within_a_code(self):
        file = self.watch("scene", *RANGE, "--depth-bits", "16", "--lossless")
        sent = png_16(file.read_bytes())
        self.assertEqual(sent.shape, (HEIGHT, 2 * WIDTH, 3))
        color = sent[:, :WIDTH]
        self.assertTrue((color % 257 == 0).all())
        codes = sent[:, WIDTH:]
        self.assertTrue((codes == codes[..., :1]).all())
        self.assertGreater(len(np.unique(codes)), 300)
        stream = self.published_again(file)
        again = png_16(self.watch(stream, *RANGE, "--depth-bits", "16",
                                  "--lossless").read_bytes())[:, WIDTH:]
        self.assertLessEqual(np.abs(again - codes).max(), 1)

    def test_two_layers_are_four_quadrants_of_8_and_of_16_bits(self):
        form = ["--rgbd-form", "two-layers"]
        eight = np.asarray(Image.open(
            self.watch("scene", *RANGE, *form, "--lossless", "--format", "png"))).astype(int)
        sixteen = png_16(self.watch("scene", *RANGE, *form, "--depth-bits", "16",
                                    "--lossless").read_bytes())
        self.assertEqual(eight.shape, (2 * HEIGHT, 2 * WIDTH, 3))
        self.assertEqual(sixteen.shape, eight.shape)
        np.testing.assert_array_equal(sixteen[:, :WIDTH], eight[:, :WIDTH] * 257)
        self.assertLessEqual(np.abs(sixteen[:, WIDTH:] - eight[:, WIDTH:] * 257).max(), 130)
        self.assertGreater((eight[:HEIGHT] != eight[HEIGHT:]).mean(), 0.02)

    def test_a_preset_is_the_form_with_the_screen_at_the_middle_code(self):
        lossless = ["--lossless", "--format", "png"]
        middle_m = 2 / (1 / NEAR_M + 1 / FAR_M)
        for preset, form in (("wowvx", "color-depth"), ("wowvx_declipse", "two-layers")):
            by_name = self.watch("scene", *RANGE, *lossless, "--preset", preset).read_bytes()
            by_hand = self.watch("scene", *RANGE, *lossless, "--rgbd-form", form,
                                 "--screen", repr(middle_m)).read_bytes()
            self.assertEqual(by_name, by_hand, preset)

    def test_jpeg_is_the_servers_own(self):
        file = self.watch("scene", "--screen", "4")
        self.assertTrue(file.name.endswith("_rgbd.jpg"), file.name)
        with Image.open(file) as picture:
            self.assertEqual(picture.size, (2 * WIDTH, HEIGHT))

    def test_refuses_what_does_not_fit_together(self):
        for bad, said in ((["--depth-bits", "16", "--depth-side", "left"],
                           "--depth-side: depth of 16 bits"),
                          (["--preset", "portrait"],
                           'there is no preset "portrait"; known presets: wowvx'),
                          (["--cone", "30"], "cannot be combined"),
                          (["--depth-near", "3", "--depth-far", "2"], "--depth-far: got 2")):
            run = subprocess.run([CLIENT, "--server", self.server.address, "watch", "scene",
                                  "--rgbd", "8x8", "--count", "1", "--no-retry", *bad],
                                 timeout=viewloomd.PATIENCE_S, capture_output=True, text=True)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn(said, run.stderr)


if __name__ == "__main__":
    unittest.main()
