# SPDX-License-Identifier: Apache-2.0
"""What single clients do: each function opens calls in a session, which ends them."""

import functools
import io
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import viewloom
from clients import Frames, mirrors, scene
from viewloom.v1 import frame_pb2

sys.path.insert(0, str(Path(__file__).parents[1] / "atlases"))
from displays import DISPLAYS, ENCODINGS  # noqa: E402

SIDE_MAX_PX = 16384
DISPLAY_COUNT, OUTPUT_RATE_HZ = 63, 240
TRACKED_COUNT = 8
POSES_HZ, FLOODED_POSES_HZ = 60, 500
BOMB_RATE_HZ = 2
IN_WORLD = {"position": {"x": 0.1, "y": 0.05}, "orientation": {"y": 0.05, "w": 0.99875}}


def quilt(side_px, columns=4, **more):
    return {"quilt": {"columns": columns, "rows": columns,
                      "size": {"width": side_px, "height": side_px}}, **more}


TRACKED = {"stereo": {"eye_size": {"width": 960, "height": 540}, "tracked": True}}
LARGE = quilt(SIDE_MAX_PX, 8)
LARGE_IN_WORLD = quilt(SIDE_MAX_PX, 8, world_pose=IN_WORLD)
LENS_MAX = quilt(2048, effects={"lens": {
    "aperture_radius_m": 0.05, "samples": 64, "gathered_samples": 256,
    "mode": "GATHER_MODE_EXACT"}})
FILTER_MAX = quilt(2048, filter={"sample_count": 16, "width": 4})
REFLECTIONS_MAX = quilt(2048, effects={"reflection": {"bounces": 4, "samples": 64}})
# Displays of one kind begin with its name.
KINDS = ("quilt", "stereo", "grid", "cameras", "lenticular", "integral", "rgbd", "lens",
         "reflections")


def requests_of(kind):
    """All displays of a kind, in all encodings."""
    return [(display, encoding) for name, display in DISPLAYS.items() if name.startswith(kind)
            for encoding in ([ENCODINGS["raw"], {}] if name == kind else [ENCODINGS["raw"]])]


def first_use(kind):
    """Each display of that kind, one after the other."""
    def load(session):
        session.publish(scene(layer_count=2))
        session.watch_in_turn(requests_of(kind))
    load.__name__ = f"first_use_of_{kind}"
    return load


def watching(display, name, frames=scene):
    """One display of a stream of its own."""
    def load(session):
        session.publish(frames())
        session.watch(display)
    load.__name__ = name
    return load


large_quilt = watching(LARGE, "large_quilt")
large_quilt_in_world = watching(LARGE_IN_WORLD, "large_quilt_in_world")
lens_at_maximum = watching(LENS_MAX, "lens_at_maximum")
filter_at_maximum = watching(FILTER_MAX, "filter_at_maximum")
reflections_at_maximum = watching(REFLECTIONS_MAX, "reflections_at_maximum", mirrors)


def lens_of_the_healthy_stream(session):
    session.watch(LENS_MAX, stream="healthy")


def tracked_in_free_motion(session):
    session.publish(scene(960, 540))
    for _ in range(TRACKED_COUNT):
        session.watch(TRACKED, poses_hz=POSES_HZ)


def tracked_and_flooded(session):
    session.publish(scene(960, 540))
    for number in range(TRACKED_COUNT):
        session.watch(TRACKED, poses_hz=FLOODED_POSES_HZ if number < 2 else POSES_HZ)


def displays_at_240_hz(session, count=DISPLAY_COUNT):
    """Displays that differ, of a stream whose camera moves."""
    session.publish(scene())
    for number in range(count):
        session.watch(quilt(256 + 4 * number, 2, effects={
            "temporal": {"output_rate_hz": OUTPUT_RATE_HZ}}))


def some_displays_at_240_hz(session):
    """As many as one of nine clients can have."""
    displays_at_240_hz(session, 12)


@functools.lru_cache
def zstd_bomb(side_px):
    """Planes of one value, which zstd packs a thousand to one."""
    color = np.zeros((side_px, side_px, 3), np.uint8)
    depth_m = np.ones((side_px, side_px), np.float32)
    return Frames([viewloom.Source([color] * 2, [depth_m, depth_m * 2], fov_y_rad=0.9,
                                   pose=np.eye(4))], zstd_level=3)


@functools.lru_cache
def jpeg_bomb(side_px):
    """A large grey JPEG of one value, beside a small plane of depth."""
    frames = Frames([viewloom.Source(np.zeros((16, 16, 3), np.uint8),
                                     np.ones((16, 16), np.float32), fov_y_rad=0.9,
                                     pose=np.eye(4))])
    packed = io.BytesIO()
    Image.new("L", (side_px, side_px)).save(packed, "JPEG")
    frames.replace_first_plane(frame_pb2.PLANE_ENCODING_JPEG, side_px, packed.getvalue())
    return frames


def bombs_of(side_px):
    def load(session):
        session.publish(zstd_bomb(side_px), BOMB_RATE_HZ, f"{session.name}.zstd")
        session.publish(jpeg_bomb(side_px), BOMB_RATE_HZ, f"{session.name}.jpeg")
        session.watch(quilt(512), stream=f"{session.name}.zstd")
    load.__name__ = f"bombs_of_{side_px}"
    return load


bombs, small_bombs = bombs_of(8192), bombs_of(2048)

FIRST_USES = tuple(map(first_use, KINDS))
SINGLE = (large_quilt, large_quilt_in_world, lens_at_maximum, filter_at_maximum,
          reflections_at_maximum, lens_of_the_healthy_stream, tracked_in_free_motion,
          tracked_and_flooded, displays_at_240_hz, bombs)
SINGLE_SHORT = (large_quilt_in_world, lens_at_maximum, tracked_and_flooded, displays_at_240_hz,
                small_bombs)
# At once, each with an identity of its own.
EIGHT = (large_quilt, large_quilt_in_world, lens_at_maximum, filter_at_maximum,
         reflections_at_maximum, tracked_and_flooded, some_displays_at_240_hz, bombs)
EIGHT_SHORT = EIGHT[:-1] + (small_bombs,)
