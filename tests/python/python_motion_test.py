# SPDX-License-Identifier: Apache-2.0
"""A thing that moves by itself, through a real server: where it is shown between frames."""

import unittest

import viewloomd  # takes its argument

import numpy as np

import viewloom
from viewloom.v1 import atlas_pb2

WIDTH_PX, HEIGHT_PX = 64, 48
FOCAL_PX = 64.0
PLATE = (slice(16, 32), slice(12, 24))  # rows and columns; 2 m away, before a wall at 4 m
SPEED_MPS = 0.9375  # to the right: 30 px/s
# While nothing new comes, speed falls to nothing within bridge_s: half of that is left to go.
BRIDGE_S = 0.4
GONE_PX = 30 * BRIDGE_S / 2
MIDDLE_ERROR_PX = 0.55  # of whole px


def scene(motion_mps):
    color = np.full((HEIGHT_PX, WIDTH_PX, 3), 32, np.uint8)
    depth = np.full((HEIGHT_PX, WIDTH_PX), 4.0, np.float32)
    motion = np.zeros((HEIGHT_PX, WIDTH_PX, 3))
    color[PLATE], depth[PLATE], motion[PLATE] = 255, 2.0, motion_mps
    return viewloom.Source(color, depth, motion=motion, intrinsics=(
        FOCAL_PX, FOCAL_PX, WIDTH_PX / 2, HEIGHT_PX / 2))


def own_place():
    return {
        "cameras": {
            "tile_size": {"width": WIDTH_PX, "height": HEIGHT_PX},
            "cameras": [{"pose": {"orientation": {"w": 1}}, "intrinsics": {
                "focal_x_px": FOCAL_PX, "focal_y_px": FOCAL_PX,
                "principal_x_px": WIDTH_PX / 2, "principal_y_px": HEIGHT_PX / 2}}]},
        "effects": {"temporal": {"output_rate_hz": 60, "bridge_s": BRIDGE_S}}}


def middle_px(atlas):
    white = atlas.color[24, :, 0].astype(float) - 32
    return (white * (np.arange(WIDTH_PX) + 0.5)).sum() / white.sum()


class Motion(unittest.TestCase):
    def setUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.server = viewloom.connect(self.daemon.address)
        self.addCleanup(self.daemon.stop)
        self.addCleanup(self.server.close)

    def atlases_until(self, is_last, source):
        with self.server.publish("plate") as publisher, \
                self.server.watch("plate", own_place(),
                                  encoding=viewloom.encoding(lossless=True)) as watcher:
            publisher.send(source)
            atlas = watcher.receive(viewloomd.PATIENCE_S)
            while not is_last(atlas):
                atlas = watcher.receive(viewloomd.PATIENCE_S)
            return atlas

    def test_goes_on_until_the_picture_is_held(self):
        held = self.atlases_until(
            lambda atlas: atlas.header.timing == atlas_pb2.TIMING_HELD,
            scene((SPEED_MPS, 0, 0)))
        self.assertAlmostEqual(middle_px(held), 18 + GONE_PX, delta=MIDDLE_ERROR_PX)

    def test_that_is_no_number_is_counted_and_stands(self):
        atlas = self.atlases_until(lambda atlas: True, scene((float("nan"), 1, 0)))
        self.assertEqual(atlas.header.stats.bad_motions_count, 16 * 12)
        self.assertEqual(middle_px(atlas), 18)


if __name__ == "__main__":
    unittest.main()
