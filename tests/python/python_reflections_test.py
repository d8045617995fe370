# SPDX-License-Identifier: Apache-2.0
"""What a mirror shows through a real server, beside what geometry says, and what is refused."""

import dataclasses
import unittest

import viewloomd  # takes its argument

import numpy as np

import viewloom

WIDTH_PX, HEIGHT_PX = 160, 120
FOCAL_PX = 120.0
WALL_M = 4.0    # in front of the camera
FLOOR_M = -1.0  # above it
# Codes: what is sent is rounded, and so is what comes.
APART = 2.5


def directions():
    """x and y of the ray through each px, for a metre along the axis."""
    x, y = np.meshgrid(np.arange(WIDTH_PX) + 0.5, np.arange(HEIGHT_PX) + 0.5)
    return (x - WIDTH_PX / 2) / FOCAL_PX, (HEIGHT_PX / 2 - y) / FOCAL_PX


def wall_color(x_m, y_m):
    """Codes that are linear over the wall."""
    return np.stack([120 + 30 * x_m, 110 + 40 * y_m, np.full_like(x_m, 60)], axis=-1)


def room(**more):
    """A wall that is seen, and a floor that is black and mirrors all there is."""
    across, up = directions()
    is_floor = WALL_M * up < FLOOR_M
    depth = np.where(is_floor, FLOOR_M / np.minimum(up, -1e-9), WALL_M)
    color = np.where(is_floor[..., None], 0, wall_color(WALL_M * across, WALL_M * up))
    normal = np.where(is_floor[..., None], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    given = {"specular": is_floor.astype(float), "normal": normal, **more}
    return viewloom.Source(np.rint(color).astype(np.uint8), depth, intrinsics=(
        FOCAL_PX, FOCAL_PX, WIDTH_PX / 2, HEIGHT_PX / 2), **given)


def mirrored():
    """Where the wall is seen in the floor: codes, and which px show that."""
    across, up = directions()
    is_floor = WALL_M * up < FLOOR_M
    floor_depth_m = FLOOR_M / np.minimum(up, -1e-9)
    # From the floor the ray rises as steeply as it fell, and goes on to the side.
    height_m = FLOOR_M - up * (WALL_M - floor_depth_m)
    return wall_color(WALL_M * across, height_m), is_floor


def own_place(**reflection):
    display = {"cameras": {
        "tile_size": {"width": WIDTH_PX, "height": HEIGHT_PX},
        "cameras": [{"pose": {"orientation": {"w": 1}}, "intrinsics": {
            "focal_x_px": FOCAL_PX, "focal_y_px": FOCAL_PX,
            "principal_x_px": WIDTH_PX / 2, "principal_y_px": HEIGHT_PX / 2}}]}}
    if reflection:
        display["effects"] = {"reflection": reflection}
    return display


class Mirrors(unittest.TestCase):
    def setUp(self):
        self.stream_count = 0
        self.daemon = viewloomd.Viewloomd()
        self.server = viewloom.connect(self.daemon.address)
        self.addCleanup(self.daemon.stop)
        self.addCleanup(self.server.close)

    def picture(self, source, **reflection):
        # Each in a stream of its own: one keeps the last frame of who published it before.
        self.stream_count += 1
        stream = f"room{self.stream_count}"
        with self.server.publish(stream) as publisher, \
                self.server.watch(stream, own_place(**reflection),
                                  encoding=viewloom.encoding(lossless=True)) as watcher:
            publisher.send(source)
            return watcher.receive(viewloomd.PATIENCE_S)

    def test_show_what_geometry_says(self):
        expected, is_floor = mirrored()
        atlas = self.picture(room(), bounces=1)
        apart = np.abs(atlas.color.astype(float) - expected).max(axis=-1)
        # Along the edge between floor and wall px of both are blended.
        inner = is_floor & np.roll(is_floor, 2, axis=0)
        self.assertLessEqual(apart[inner].max(), APART)
        shares = atlas.end.reflections
        self.assertGreater(shares.hit, 0.95)
        self.assertAlmostEqual(shares.hit + shares.assumed + shares.back + shares.cube +
                               shares.environment, 1, places=9)

    def test_face_as_depth_slopes_where_normals_have_no_length(self):
        expected, is_floor = mirrored()
        source = room(normal=np.zeros((HEIGHT_PX, WIDTH_PX, 3)))
        atlas = self.picture(source, bounces=1)
        self.assertEqual(atlas.header.stats.bad_normals_count, WIDTH_PX * HEIGHT_PX)
        inner = is_floor & np.roll(is_floor, 4, axis=0)
        apart = np.abs(atlas.color.astype(float) - expected).max(axis=-1)
        self.assertLess(np.median(apart[inner]), APART)

    def test_show_the_environment_where_nothing_is(self):
        _, is_floor = mirrored()
        normal = np.zeros((HEIGHT_PX, WIDTH_PX, 3))
        normal[...] = [0, 1, 1]  # leans towards the camera: what it mirrors is above the picture
        atlas = self.picture(room(normal=normal), bounces=1, environment_rgb=0x204060)
        self.assertGreater(atlas.end.reflections.environment, 0.8)
        shown = atlas.color[is_floor]
        self.assertGreater((np.abs(shown.astype(int) - [0x20, 0x40, 0x60]).max(axis=-1) <= 1)
                           .mean(), 0.8)

    def test_add_nothing_unasked_or_where_colour_has_it(self):
        _, is_floor = mirrored()
        plain = self.picture(room())
        self.assertFalse(plain.end.HasField("reflections"))
        self.assertEqual(plain.color[is_floor & np.roll(is_floor, 2, axis=0)].max(), 0)
        had = self.picture(room(color_has_reflections=True), bounces=1)
        np.testing.assert_array_equal(had.color, plain.color)

    def test_show_what_another_source_holds(self):
        expected, is_floor = mirrored()
        halves = [room(), room()]
        for source, is_kept in zip(halves, (is_floor, ~is_floor)):
            source.depth[~is_kept] = 0  # nothing is there
        atlas = self.picture(halves, bounces=1)
        inner = is_floor & np.roll(is_floor, 2, axis=0)
        apart = np.abs(atlas.color.astype(float) - expected).max(axis=-1)
        self.assertLessEqual(apart[inner].max(), APART)
        self.assertGreater(atlas.end.reflections.hit, 0.95)

    def test_are_refused_of_colour_that_is_seen_through(self):
        opaque = room()
        half = np.full((HEIGHT_PX, WIDTH_PX), 128, np.uint8)
        glass = dataclasses.replace(opaque, alpha="straight",
                                    color=np.dstack([opaque.color, half]))
        for sources in (glass, [opaque, glass]):
            with self.assertRaises(viewloom.ViewloomError) as refusal:
                self.picture(sources, bounces=1)
            self.assertEqual(refusal.exception.status.name, "FAILED_PRECONDITION")
            self.assertIn("transparent colour", refusal.exception.message)
            self.assertIn("effects.reflection", str(refusal.exception))


if __name__ == "__main__":
    unittest.main()
