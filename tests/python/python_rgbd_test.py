# SPDX-License-Identifier: Apache-2.0
"""Colour with depth beside it, of a real server: codes of 8 and 16 bits, and what lies behind."""

import unittest

import viewloomd  # takes its argument

import numpy as np

import scene
import viewloom
from viewloom.v1 import atlas_pb2

LOSSLESS = viewloom.encoding(lossless=True)
SIZE = {"width": scene.WIDTH_PX, "height": scene.HEIGHT_PX}
TWO_LAYERS = "RGBD_FORM_TWO_LAYERS"
ROUNDED = 0.501  # codes, and the rounding of binary32
WALL_M = 4.0


def expected_codes(depth_m, near_m, far_m, bits=8, black_near=False):
    """Before they are rounded."""
    share = (1 / depth_m.astype(np.float64) - 1 / far_m) / (1 / near_m - 1 / far_m)
    share = np.clip(1 - share if black_near else share, 0, 1)
    return share * (2 ** bits - 1)


def error_of(codes, expected):
    """The largest; 0.5 of what is rounded."""
    return np.abs(codes.astype(np.float64) - expected).max()


class Rgbd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = viewloomd.Viewloomd()
        cls.server = viewloom.connect(cls.daemon.address)
        # A ramp of distances, before a wall that only layer 1 knows.
        x = np.linspace(2, 6, scene.WIDTH_PX, dtype=np.float32)
        cls.near_m = np.broadcast_to(x, (scene.HEIGHT_PX, scene.WIDTH_PX)).copy()
        cls.far_m = np.full_like(cls.near_m, np.nan)
        cls.far_m[30:90, 40:120] = 9
        cls.colors = [scene.noise_color(1), scene.noise_color(2)]
        with cls.server.publish("ramp") as publisher:
            publisher.send(scene.source(cls.colors, [cls.near_m, cls.far_m])).result(
                viewloomd.PATIENCE_S)
        with cls.server.publish("pair") as publisher:
            other = np.eye(4)
            other[0, 3] = 0.1
            wall_m = np.full_like(cls.near_m, WALL_M)
            publisher.send([scene.source(cls.colors[0], wall_m),
                            scene.source(cls.colors[1], wall_m, pose=other)]).result(
                                viewloomd.PATIENCE_S)

    @classmethod
    def tearDownClass(cls):
        cls.server.close()
        cls.daemon.stop()

    def still(self, encoding=LOSSLESS, stream="ramp", **rgbd):
        return self.server.still(stream, {"rgbd": {"view_size": SIZE, **rgbd}}, encoding=encoding)

    def test_codes_of_8_bits_stand_beside_the_colour(self):
        for near_is_black in (False, True):
            for placement, color_view in (("RIGHT", 0), ("LEFT", 1), ("TOP", 1), ("BOTTOM", 0)):
                atlas = self.still(near_m=2.5, far_m=7, black_near=near_is_black,
                                   depth_placement=f"DEPTH_PLACEMENT_{placement}")
                np.testing.assert_array_equal(atlas.view(color_view), self.colors[0])
                expected = expected_codes(self.near_m, 2.5, 7, 8, near_is_black)
                self.assertLess(error_of(atlas.depth_codes, expected), ROUNDED)
                self.assertEqual(atlas.depth_codes.dtype, np.uint8)
                grey = atlas.view(1 - color_view)
                np.testing.assert_array_equal(grey, np.repeat(grey[..., :1], 3, axis=-1))

    def test_the_range_is_the_streams_where_none_is_given(self):
        atlas = self.still()
        low, high = np.percentile(1 / self.near_m, (2, 98))
        codes = atlas.layout.depth_codes
        self.assertAlmostEqual(codes.inv_z_near, high, delta=0.02 * high)
        self.assertAlmostEqual(codes.inv_z_far, low, delta=0.02 * low)
        inv_z = 1 / self.near_m.astype(np.float64)
        inside = (inv_z < codes.inv_z_near) & (inv_z > codes.inv_z_far)
        step = (codes.inv_z_near - codes.inv_z_far) / 255
        self.assertLessEqual(np.abs(atlas.code_inv_z() - inv_z)[inside].max(), 0.501 * step)

    def test_codes_of_16_bits_come_beside_the_colour(self):
        for form, planes in (("RGBD_FORM_COLOR_DEPTH", "ZSTD"), (TWO_LAYERS, "RAW")):
            encoding = {"color": "BAND_ENCODING_ZSTD", "planes": f"BAND_ENCODING_{planes}"}
            atlas = self.still(encoding, form=form, near_m=2, far_m="Infinity", depth_bits=16)
            self.assertEqual(list(atlas.layout.depth_codes.depth_views), [])
            self.assertEqual(atlas.depth_codes.dtype, np.uint16)
            self.assertEqual(atlas.depth_codes.shape, atlas.color.shape[:2])
            first = atlas.depth_codes[:scene.HEIGHT_PX]
            self.assertLess(error_of(first, expected_codes(self.near_m, 2, np.inf, 16)), 0.6)
            np.testing.assert_array_equal(atlas.view(0), self.colors[0])

    def test_what_lies_behind_stands_below_and_the_first_where_nothing_does(self):
        atlas = self.still(form=TWO_LAYERS, near_m=2, far_m=10)
        self.assertEqual(atlas.header.method, atlas_pb2.TRACE_METHOD_WALK)
        has_wall = ~np.isnan(self.far_m)
        behind_m = np.where(has_wall, self.far_m, self.near_m)
        first, second = np.vsplit(atlas.depth_codes, 2)
        self.assertLess(error_of(first, expected_codes(self.near_m, 2, 10)), ROUNDED)
        self.assertLess(error_of(second, expected_codes(behind_m, 2, 10)), ROUNDED)
        np.testing.assert_array_equal(atlas.view(0), self.colors[0])
        np.testing.assert_array_equal(
            atlas.view(2), np.where(has_wall[..., None], self.colors[1], self.colors[0]))

    def test_jpeg_keeps_codes_where_chroma_is_not_shared(self):
        exact = self.still(near_m=2, far_m=7).depth_codes.astype(int)
        layout = self.still(None, near_m=2, far_m=7).layout
        self.assertEqual(layout.encoding.chroma, atlas_pb2.CHROMA_SUBSAMPLING_444)
        for quality, chroma in ((85, 420), (85, 444), (95, 420), (95, 444)):
            jpeg = self.still(viewloom.encoding(jpeg_quality=quality, chroma=chroma),
                              near_m=2, far_m=7)
            error = np.abs(jpeg.depth_codes.astype(int) - exact)
            print(f"JPEG {quality} {chroma}: mean error {error.mean():.3f} codes, "
                  f"99.9 % {np.percentile(error, 99.9):.0f}, worst {error.max()}; "
                  f"{len(jpeg.jpeg)} bytes")
            self.assertLessEqual(error.mean(), 0.3)
            self.assertTrue(chroma == 420 or error.max() <= 2)

    def test_several_sources_have_codes_but_no_layer_behind(self):
        wall_code = round(float(expected_codes(np.float64(WALL_M), 2.5, 7)))
        atlas = self.still(stream="pair", near_m=2.5, far_m=7)
        self.assertEqual(np.unique(atlas.depth_codes).tolist(), [wall_code])
        with self.assertRaises(viewloom.ViewloomError) as refusal:
            self.still(stream="pair", form=TWO_LAYERS)
        self.assertEqual(refusal.exception.status.name, "FAILED_PRECONDITION")
        self.assertIn("2 sources", refusal.exception.message)

    def test_refuses_a_range_without_depth_and_other_displays_have_no_codes(self):
        with self.assertRaises(viewloom.ViewloomError) as refusal:
            self.still(near_m=50)
        self.assertEqual(refusal.exception.status.name, "FAILED_PRECONDITION")
        with self.assertRaises(viewloom.BadInput):
            self.server.still("ramp", scene.own_place()).code_inv_z()


if __name__ == "__main__":
    unittest.main()
