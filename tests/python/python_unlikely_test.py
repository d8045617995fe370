# SPDX-License-Identifier: Apache-2.0
"""Arrays as people have them: which are taken, which are warned of, and with which remedy."""

import unittest
import warnings

import grpc
import numpy as np
from PIL import Image

import viewloom
from viewloom.frame_messages import frame_messages
from viewloom.frame_warnings import FrameWarnings

HEIGHT_PX, WIDTH_PX = 12, 16
COLOR = np.random.default_rng(1).integers(0, 256, (HEIGHT_PX, WIDTH_PX, 3), np.uint8)
DEPTH = np.linspace(1, 4, HEIGHT_PX * WIDTH_PX, dtype=np.float32).reshape(HEIGHT_PX, WIDTH_PX)
MILLIMETRES = {"meaning": "DEPTH_MEANING_PLANAR", "scale": 0.001, "invalid_value": 0}
METRES = {"meaning": "DEPTH_MEANING_PLANAR"}


def sent(color=COLOR, depth=DEPTH, **more):
    """The bytes of the planes that go to the server, joined."""
    source = viewloom.Source(color, depth, fov_y_rad=1.0, **more)
    return b"".join(message.chunk.data for message in frame_messages(1, source, capture_time_ns=1)
                    if message.HasField("chunk"))


def warned(color=COLOR, depth=DEPTH, frame_warnings=None, **more):
    """What is said of a frame that is accepted."""
    source = viewloom.Source(color, depth, fov_y_rad=1.0, **more)
    frame_messages(1, source, capture_time_ns=1)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        (frame_warnings or FrameWarnings()).frame(source)
    assert all(entry.category is viewloom.UnlikelyInput for entry in caught)
    return [str(entry.message) for entry in caught]


class Tensor:
    """As torch's: numpy takes it, or is told why not."""

    def __init__(self, array, problem=None):
        self.array, self.problem = array, problem

    def __array__(self, dtype=None):
        if self.problem:
            raise self.problem
        return np.asarray(self.array, dtype)


class Taken(unittest.TestCase):
    def test_depth_with_one_channel_is_that_depth(self):
        for depth in (DEPTH[..., None], DEPTH[None]):
            self.assertEqual(sent(depth=depth), sent())

    def test_any_order_of_bytes_and_rows_is_the_same_frame(self):
        self.assertEqual(sent(depth=DEPTH.astype(">f4")), sent())
        self.assertEqual(sent(depth=np.asfortranarray(DEPTH)), sent())
        self.assertEqual(sent(depth=np.repeat(DEPTH, 2, axis=1)[:, ::2]), sent())
        bgr = np.ascontiguousarray(COLOR[..., ::-1])
        self.assertEqual(sent(color=bgr[..., ::-1]), sent())
        light = COLOR / 255
        self.assertEqual(sent(color=light.astype(">f8")), sent(color=light))
        counted = (DEPTH * 1000).astype(np.uint16)
        self.assertEqual(sent(depth=counted.astype(">u2"), depth_format=MILLIMETRES),
                         sent(depth=counted, depth_format=MILLIMETRES))

    def test_tensors_and_images_are_taken_as_arrays(self):
        self.assertEqual(sent(color=Tensor(COLOR), depth=Tensor(DEPTH)), sent())
        self.assertEqual(sent(color=Image.fromarray(COLOR)), sent())


class Refused(unittest.TestCase):
    def refused(self, remedy, **given):
        with self.assertRaises(viewloom.BadInput) as refusal:
            sent(**given)
        self.assertIn(remedy, refusal.exception.message)

    def test_each_with_what_to_give_instead(self):
        self.refused("numpy.moveaxis(color, 0, -1)", color=np.moveaxis(COLOR, -1, 0))
        self.refused("numpy.dstack([color] * 3)", color=COLOR[..., 0])
        self.refused("color[0] is the first of a batch", color=COLOR[None])
        self.refused("depth[0, 0]", depth=DEPTH[None, None])
        self.refused("/ 65535", color=COLOR.astype(np.uint16) * 257)
        self.refused("/ 65535", color=COLOR * 257.0)
        self.refused("color.astype(numpy.uint8)", color=COLOR.astype(np.int64))
        self.refused("millimetres become depth / 1000", depth=(DEPTH * 1000).astype(np.int32))
        self.refused("'scale': 0.001", depth=(DEPTH * 1000).astype(np.uint16))
        self.refused("filled(numpy.nan)", depth=np.ma.masked_less(DEPTH, 2))
        self.refused("numpy.array(depth[0])", color=[COLOR], depth=[DEPTH.tolist()])
        self.refused("detach().cpu().numpy()",
                     depth=Tensor(DEPTH, TypeError("can't convert cuda:0 device type tensor")))

    def test_the_remedies_are_taken(self):
        planar = np.moveaxis(COLOR, -1, 0)
        for color in (np.moveaxis(planar, 0, -1), COLOR.astype(np.int64).astype(np.uint8)):
            self.assertEqual(sent(color=color), sent())
        sent(color=np.dstack([COLOR[..., 0]] * 3))
        self.assertEqual(warned(color=COLOR.astype(np.uint16) * 257 / 65535, transfer="srgb"), [])


class Warned(unittest.TestCase):
    def test_usual_frames_are_not(self):
        self.assertEqual(warned(), [])
        self.assertEqual(warned(color=(COLOR / 255) ** 2.2), [])
        sky = np.where(DEPTH < 1.1, DEPTH, np.inf)
        self.assertEqual(warned(depth=sky), [])
        self.assertEqual(warned(depth=(DEPTH * 1000).astype(np.uint16), depth_format=MILLIMETRES),
                         [])
        sparkle = np.full(COLOR.shape, 0.2, np.float32)
        sparkle[3, 3] = 900  # a lamp
        self.assertEqual(warned(color=sparkle), [])

    def test_depth_without_a_surface_is_named_with_what_it_holds(self):
        cases = {"100% NaN": DEPTH * np.nan, "100% 0": DEPTH * 0, "100% negative": -DEPTH,
                 "100% infinite": DEPTH * np.inf}
        for held, depth in cases.items():
            said, = warned(depth=depth)
            self.assertIn("depth shows no surface", said)
            self.assertIn(held, said)
        self.assertIn("give -depth", warned(depth=-DEPTH)[0])
        self.assertEqual(warned(depth=-(-DEPTH)), [])
        mixed = np.where(DEPTH < 2, np.nan, 0)
        self.assertRegex(warned(depth=mixed)[0], "33% NaN, 67% 0")
        blank = np.full(DEPTH.shape, 7, np.uint16)
        self.assertIn("invalid_value", warned(
            depth=blank, depth_format={**MILLIMETRES, "invalid_value": 7})[0])
        self.assertEqual(warned(color=[COLOR, COLOR], depth=[DEPTH, DEPTH * np.nan]), [])

    def test_each_thing_is_said_once_a_stream(self):
        stream = FrameWarnings()
        self.assertEqual(warned(frame_warnings=stream), [])
        self.assertEqual(len(warned(depth=DEPTH * np.nan, frame_warnings=stream)), 1)
        self.assertEqual(warned(depth=DEPTH * np.nan, frame_warnings=stream), [])
        self.assertEqual(warned(depth=DEPTH * 0, frame_warnings=stream), [])

    def test_floats_of_0_to_255_are_noticed(self):
        for color in (COLOR.astype(np.float32), COLOR.astype(np.float64) * 0.99):
            said, = warned(color=color)
            self.assertIn('color / 255 with transfer="srgb"', said)
        self.assertEqual(warned(color=COLOR / 255, transfer="srgb"), [])
        said, = warned(color=(COLOR * 200.0))
        self.assertIn("color / 65535", said)
        dark = np.minimum(COLOR, 1)
        self.assertIn("0 and 1 alone", warned(color=dark)[0])
        self.assertEqual(warned(color=COLOR * 0), [])

    def test_millimetres_in_floats_are_noticed_unless_metres_are_stated(self):
        said, = warned(depth=DEPTH * 1000)
        self.assertIn("depth / 1000", said)
        self.assertEqual(warned(depth=DEPTH * 1000 / 1000), [])
        self.assertEqual(warned(depth=DEPTH * 1000, depth_format=METRES), [])

    def test_one_picture_that_is_turned_is_noticed(self):
        said, = warned(depth=np.ascontiguousarray(DEPTH.T))
        self.assertIn("depth.T", said)


class Printed(unittest.TestCase):
    def test_an_error_drives_no_terminal(self):
        error = viewloom.ViewloomError(grpc.StatusCode.NOT_FOUND, "a",
                                       "is \x1b[2J\u202ebad\x9b, no")
        self.assertEqual(str(error), "NOT_FOUND: a: is \\x1b[2J\\u202ebad\\x9b, no")
        self.assertEqual(error.message, "is \x1b[2J\u202ebad\x9b, no")

    def test_a_source_is_one_line(self):
        text = repr(viewloom.Source([COLOR, COLOR], [DEPTH, DEPTH], fov_y_rad=1.0, pose=np.eye(4)))
        self.assertEqual(text, "viewloom.Source(color=[uint8[12][16][3], uint8[12][16][3]], "
                         "depth=[float32[12][16], float32[12][16]], fov_y_rad=1.0, "
                         "pose=float64[4][4])")
        listed = repr(viewloom.Source(COLOR, DEPTH, pose=np.eye(4).tolist(), fov_y_rad=1.0,
                                      depth_format=METRES))
        self.assertNotIn("\n", listed)
        self.assertLess(len(listed), 250)


if __name__ == "__main__":
    unittest.main()
