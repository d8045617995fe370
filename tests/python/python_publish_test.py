# SPDX-License-Identifier: Apache-2.0
"""numpy pictures through a real server: what is published is what a view from there shows."""

import unittest

import viewloomd  # takes its argument

import numpy as np

import scene
import viewloom
from viewloom.v1 import ingest_service_pb2 as ingest
from viewloom.v1.atlas_pb2 import RAY_CLASS_HIDDEN, RAY_CLASS_HIT, RAY_CLASS_HIT_ASSUMED

LOSSLESS = viewloom.encoding(lossless=True, depth=True, mask=True)
FINE_JPEG = viewloom.encoding(jpeg_quality=95, chroma=444)
JPEG_ERROR_MAX = 6  # of 255, at quality 95, of slow ramps
INV_Z_ERROR_MAX = 1e-6  # 1/m: depth goes through a division, and is bounded outwards


# A gradient of 32x32 px by x264: high profile, full range, BT.601.
VIDEO = bytes.fromhex(
    "000000016764100aacb92d80b702020640000003004000000f010000000168ee06f2c00000016588843fad36"
    "59a490ea31ea5884ba27575b5052d38f6825cb0571e0c51338df351baf2c38ba796a9ed683d18d4edc4687b1"
    "b1c7782ecce34de0eaa0d8eb71f923ef12d01b34f08ceb51459860015e3a20e86f04b4ad273ac07f2e380cff"
    "16da1f0916351360fe32c814b5c0b9759f781f4a047781c50bf14bffd47e0599bfc1")


def srgb_from_linear(light):
    """IEC 61966-2-1, to 0..255."""
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


class Publishing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = viewloomd.Viewloomd()
        cls.addClassCleanup(cls.daemon.stop)
        cls.server = viewloom.connect(cls.daemon.address)
        cls.addClassCleanup(cls.server.close)

    def publish(self, *sources, display, encoding=LOSSLESS, zstd_level=0):
        """The atlas of one frame, published under the test's name."""
        with self.server.publish(self.id().split(".")[-1], zstd_level=zstd_level) as publisher:
            report = publisher.send(sources).result(viewloomd.PATIENCE_S)
            self.assertEqual(report.stats.bad_samples_count, 0)
            return self.server.still(self.id().split(".")[-1], display, encoding=encoding,
                                     timeout_s=viewloomd.PATIENCE_S)

    def test_a_frame_is_reported(self):
        with self.server.publish("reported") as publisher:
            self.assertEqual(publisher.accepted.layer_count_max, 4)
            color = scene.noise_color()
            reports = [publisher.send(scene.source(shown, scene.step_depth()),
                                      capture_time_ns=40 + number).result(viewloomd.PATIENCE_S)
                       for number, shown in ((1, color), (2, 255 - color), (3, 255 - color))]
            still = self.server.still("reported", scene.own_place())
            self.assertEqual([report.number for report in reports], [1, 2, 3])
            self.assertEqual([report.outcome for report in reports],
                             [ingest.FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY] * 2 +
                             [ingest.FRAME_OUTCOME_UNCHANGED])
            self.assertAlmostEqual(reports[0].stats.inv_z_max, 1 / scene.NEAR_M, delta=1e-4)
            self.assertEqual((still.header.frame_number, still.header.capture_time_ns), (2, 42))

    def test_video_that_was_coded_elsewhere_is_taken_or_refused_by_name(self):
        def report_of(publisher, video):
            source = viewloom.Source(viewloom.CodedColor(video, (32, 32)),
                                     np.full((32, 32), 2.0, np.float32), fov_y_rad=0.6)
            return publisher.send(source).result(viewloomd.PATIENCE_S)

        with self.server.publish("coded") as publisher:
            self.assertEqual(report_of(publisher, VIDEO).outcome,
                             ingest.FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY)
            with self.assertRaisesRegex(
                    viewloom.ViewloomError,
                    r"layers\[0\]\.planes\[0\].*parameter sets without a picture"):
                report_of(publisher, VIDEO[:VIDEO.index(b"\0\0\1\x65")])

    def test_the_sources_own_view_is_the_picture_exactly(self):
        color, depth_m = scene.noise_color(), scene.step_depth()
        for level in (0, 3):
            atlas = self.publish(scene.source(color, depth_m), display=scene.own_place(),
                                 zstd_level=level)
            np.testing.assert_array_equal(atlas.view(0), color)
            np.testing.assert_allclose(atlas.view_inv_z(0), 1 / depth_m, atol=INV_Z_ERROR_MAX)
            np.testing.assert_array_equal(atlas.view_mask(0), RAY_CLASS_HIT)

    def test_the_middle_view_of_a_quilt_is_the_picture(self):
        noise, ramps, depth_m = scene.noise_color(), scene.smooth_color(), scene.step_depth()
        lossless = self.publish(scene.source(noise, depth_m), display=scene.quilt(3, 1))
        np.testing.assert_array_equal(lossless.view(1), noise)
        self.assertFalse(np.array_equal(lossless.view(0), noise))
        jpeg = self.publish(scene.source(ramps, depth_m), display=scene.quilt(3, 1),
                            encoding=FINE_JPEG)
        difference = np.abs(jpeg.view(1).astype(int) - ramps)
        self.assertLessEqual(difference.max(), JPEG_ERROR_MAX)

    def test_a_posed_source_is_seen_from_its_pose(self):
        color, depth_m = scene.noise_color(), scene.step_depth()
        pose = np.array([[0.0, 0, 1, 5], [0, 1, 0, 1], [-1, 0, 0, 2], [0, 0, 0, 1]])
        display = {**scene.own_place(), "world_pose": {
            "position": {"x": 5, "y": 1, "z": 2},
            "orientation": {"y": 0.5 ** 0.5, "w": 0.5 ** 0.5}}}
        atlas = self.publish(scene.source(color, depth_m, pose=pose), display=display)
        # A world pose goes through a rotation, and back: hits are where they were within rounding.
        same = np.abs(atlas.view(0).astype(int) - color).max(axis=2) <= 1
        self.assertGreater(same.mean(), 0.99)

    def test_linear_light_comes_out_as_srgb(self):
        light = np.linspace(0, 1, scene.WIDTH_PX * scene.HEIGHT_PX * 3)
        light = light.reshape(scene.HEIGHT_PX, scene.WIDTH_PX, 3)
        for kind in (np.float16, np.float32, np.float64):
            atlas = self.publish(scene.source(light.astype(kind), scene.step_depth()),
                                 display=scene.own_place())
            np.testing.assert_allclose(atlas.view(0), srgb_from_linear(light), atol=1)

    def test_light_brighter_than_white_is_mapped_as_asked(self):
        stops = np.linspace(-6, 5, scene.WIDTH_PX)
        ramp = np.broadcast_to(0.18 * 2.0 ** stops, (scene.HEIGHT_PX, scene.WIDTH_PX))
        light = np.stack([ramp, ramp, ramp], axis=-1).copy()
        light[40:] *= [1, 0.1, 0]
        light = light.astype(np.float16)

        def curve(value):
            power = np.clip(value, 0, 16) ** 1.25
            k = 0.82 * 0.18 ** 1.25 / (0.18 - (0.18 / 16) ** 1.25)
            return (1 + k / 32) * power / (power + k)

        inset = 0.55 * np.eye(3) + 0.15
        dark = (0.15 / 0.7) ** 1.25  # of a primary, left of the other channels behind the curve
        outset = dark / (1 - dark)   # what is taken back: it leaves none below 0
        undo = (1 + 3 * outset) * np.eye(3) - outset
        exact = light.astype(np.float64)
        expected = {"clip": np.clip(exact, 0, 1), "filmic": curve(exact),
                    "agx": np.clip(curve(exact @ inset) @ undo, 0, 1)}
        with self.server.publish("mapped") as publisher:
            for name, mapped in expected.items():
                publisher.send(scene.source(light, scene.step_depth()),
                               tone_map=name).result(viewloomd.PATIENCE_S)
                shown = self.server.still("mapped", scene.own_place(), encoding=LOSSLESS).color
                self.assertLess(np.abs(shown - srgb_from_linear(mapped)).max(), 0.8, name)
            with self.assertRaisesRegex(viewloom.BadInput, "clip, filmic, agx"):
                publisher.send(scene.source(light, scene.step_depth()), tone_map="gamma")

    def test_depth_in_millimetres_is_the_same_depth(self):
        millimetres = (scene.step_depth() * 1000).astype(np.uint16)
        atlas = self.publish(
            scene.source(scene.noise_color(), millimetres,
                         depth_format={"meaning": "DEPTH_MEANING_PLANAR", "scale": 0.001}),
            display=scene.own_place())
        np.testing.assert_allclose(atlas.view_inv_z(0), 1 / scene.step_depth(), rtol=1e-3)

    def test_a_layer_behind_shows_what_one_layer_hides(self):
        shape = (scene.HEIGHT_PX, scene.WIDTH_PX)
        front, red = scene.step_depth(), np.full((*shape, 3), (220, 40, 30), np.uint8)
        wall, noise = np.full(shape, scene.FAR_M, np.float32), scene.noise_color()
        focal_px = scene.WIDTH_PX / 2 / 0.8
        wall_shift_px = 12  # whole, so that colours come through as they are
        beside = scene.cameras([wall_shift_px * scene.FAR_M / focal_px])
        one = self.publish(scene.source(red, front), display=beside)
        two = self.publish(scene.source([red, noise], [front, wall]), display=beside)
        # To the right of the square, which moves twice as far as the wall behind it.
        uncovered = np.s_[41:79, 77:87]
        np.testing.assert_array_equal(one.view_mask(0)[uncovered], RAY_CLASS_HIDDEN)
        np.testing.assert_array_equal(two.view_mask(0)[uncovered], RAY_CLASS_HIT_ASSUMED)
        np.testing.assert_array_equal(two.view(0)[uncovered], noise[41:79, 77 + 12:87 + 12])

    def test_a_cube_map_is_seen_all_around(self):
        side = 32
        faces = np.zeros((6 * side, side, 3), np.uint8)
        faces[:] = np.arange(6).repeat(side)[:, None, None] * 40
        source = viewloom.Source(faces, np.full(faces.shape[:2], 3.0), cube_map=True)
        half = np.pi / 4 - 0.01
        fov = {"angle_left_rad": -half, "angle_right_rad": half, "angle_up_rad": half,
               "angle_down_rad": -half}
        forward, right = {"fov": fov}, {"fov": fov, "pose": {
            "orientation": {"y": -(0.5 ** 0.5), "w": 0.5 ** 0.5}}}
        atlas = self.publish(source, display={"cameras": {
            "cameras": [forward, right], "tile_size": {"width": 16, "height": 16}}})
        self.assertEqual([int(np.median(atlas.view(view))) for view in (0, 1)], [5 * 40, 0])


if __name__ == "__main__":
    unittest.main()
