# SPDX-License-Identifier: Apache-2.0
"""What the package takes and refuses before anything is sent."""

import math
import subprocess
import sys
import unittest

import numpy as np

import viewloom
from viewloom.camera import pose_from
from viewloom.display import display_from
from viewloom.frame_messages import CHUNK_BYTES_MAX, frame_messages
from viewloom.v1 import display_pb2, frame_pb2

COLOR = np.zeros((4, 6, 3), np.uint8)
DEPTH = np.ones((4, 6), np.float32)


def messages_of(source, **more):
    return frame_messages(1, source, capture_time_ns=5, **more)


def planes_of(source):
    return [plane for layer in messages_of(source)[0].header.sources[0].layers
            for plane in layer.planes]


class Refusals(unittest.TestCase):
    def refused(self, field, words, color=COLOR, depth=DEPTH, **more):
        with self.assertRaises(viewloom.BadInput) as refusal:
            messages_of(viewloom.Source(color, depth, **{"fov_y_rad": 1.0, **more}))
        self.assertEqual(refusal.exception.field, field)
        self.assertEqual(refusal.exception.status.name, "INVALID_ARGUMENT")
        self.assertIn(words, refusal.exception.message)
        self.assertIn(field, str(refusal.exception))

    def test_colour_of_another_shape_or_type(self):
        self.refused("color", "is a bytes", color=b"rgb")
        self.refused("color", "has the shape 4x6,", color=COLOR[..., 0])
        self.refused("color", "has the shape 4x6x2", color=COLOR[..., :2])
        self.refused("color", "has the shape 0x6x3", color=COLOR[:0])
        self.refused("color", "samples of uint16", color=COLOR.astype(np.uint16))
        self.refused("color", "samples of bool", color=COLOR.astype(bool))

    def test_coded_colour_that_says_no_picture(self):
        self.refused("color", "'avif', must be one of h264, jpeg",
                     color=viewloom.CodedColor(b"x", (6, 4), "avif"))
        self.refused("color", "no bytes", color=viewloom.CodedColor(b"", (6, 4)))
        self.refused("color", "(width, height)", color=viewloom.CodedColor(b"x", (6, 0)))
        self.refused("alpha", "must be opaque, as color is coded",
                     color=viewloom.CodedColor(b"x", (6, 4)), alpha="straight")

    def test_light_that_binary16_cannot_hold(self):
        for value in (70000.0, math.inf, math.nan):
            color = np.zeros((4, 6, 3))
            color[1, 2, 0] = value
            self.refused("color", "must be finite and at most 65504", color=color)

    def test_depth_of_another_shape_or_type(self):
        self.refused("depth[0]", "is a list", depth=[[1.0]], color=[COLOR])
        self.refused("depth", "has the shape 4x6x2", depth=np.dstack([DEPTH, DEPTH]))
        self.refused("depth", "samples of int32", depth=DEPTH.astype(np.int32))
        self.refused("depth_format", "is needed, as depth is uint16", depth=DEPTH.astype(np.uint16))
        self.refused("depth_format", 'no field named "unit"', depth_format={"unit": "mm"})

    def test_layers_that_do_not_fit_each_other(self):
        self.refused("color", "has 2 layers, must have as many as depth, 1", color=[COLOR, COLOR])
        self.refused("color", "has 5 layers", color=[COLOR] * 5, depth=[DEPTH] * 5)
        self.refused("color", "has 0 layers", color=[], depth=[])
        self.refused("depth[1]", "is 6x3 px, must be that of layer 0, 6x4", color=[COLOR, COLOR],
                     depth=[DEPTH, DEPTH[1:]])

    def test_surfaces_that_cannot_be(self):
        self.refused("normal", "samples of int32", normal=np.ones((4, 6, 3), np.int32))
        self.refused("normal", "has the shape 4x6,", normal=DEPTH)
        self.refused("normal_space", "camera, world", normal=np.ones((4, 6, 3)),
                     normal_space="eye")
        self.refused("roughness", "holds 1.5, must lie in 0..1", roughness=DEPTH * 1.5)
        self.refused("roughness", "holds nan", roughness=DEPTH * math.nan)
        self.refused("specular[1]", "holds -1.0", color=[COLOR] * 2, depth=[DEPTH] * 2,
                     specular=[DEPTH, -DEPTH])
        self.refused("specular", "has 1 layers, must have as many as depth, 2",
                     color=[COLOR] * 2, depth=[DEPTH] * 2, specular=DEPTH)

    def test_motion_that_cannot_be(self):
        self.refused("motion", "samples of int32", motion=np.ones((4, 6, 3), np.int32))
        self.refused("motion", "has the shape 4x6,", motion=DEPTH)
        self.refused("motion", "has 1 layers, must have as many as depth, 2",
                     color=[COLOR] * 2, depth=[DEPTH] * 2, motion=np.ones((4, 6, 3)))

    def test_words_that_mean_nothing(self):
        self.refused("transfer", "srgb, linear", transfer="gamma")
        self.refused("primaries", "bt709, display_p3, bt2020", primaries="adobe")
        self.refused("alpha", "opaque, straight, premultiplied", alpha="yes")
        self.refused("alpha", "three channels", alpha="straight")

    def test_cameras_without_or_with_two_projections(self):
        self.refused("camera", "no projection", fov_y_rad=None)
        self.refused("camera", "fov_y_rad and intrinsics", intrinsics=(1, 1, 0, 0))
        self.refused("fov_y_rad", "is 60, must lie between 0 and pi (radians)", fov_y_rad=60)
        self.refused("intrinsics", "four numbers", fov_y_rad=None, intrinsics=np.eye(3))
        self.refused("fov_y_rad", "face of a cube map", cube_map=True)

    def test_poses_that_are_no_turn_and_place(self):
        self.refused("pose", "shape (3, 4)", pose=np.eye(4)[:3])
        self.refused("pose", "no rotation", pose=np.diag([2.0, 2, 2, 1]))
        self.refused("pose", "no rotation", pose=np.diag([-1.0, 1, 1, 1]))
        self.refused("pose", "must end with 0 0 0 1",
                     pose=np.eye(4) + np.eye(4, k=-1) * [0, 0, 1, 0])

    def test_frames_of_something_else(self):
        for sources in ([], [COLOR]):
            with self.assertRaisesRegex(viewloom.BadInput, "sources"):
                messages_of(sources)

    def test_displays_and_encodings_of_something_else(self):
        with self.assertRaisesRegex(viewloom.BadInput, 'no field named "colums"'):
            display_from({"quilt": {"colums": 3}})
        with self.assertRaisesRegex(viewloom.BadInput, "display: is a int"):
            display_from(7)
        with self.assertRaisesRegex(viewloom.BadInput, "must be 420 or 444"):
            viewloom.encoding(chroma=422)


class Wire(unittest.TestCase):
    def test_chunks_hold_a_mebibyte_at_most_and_join_to_the_array(self):
        color = np.random.default_rng(3).integers(0, 256, (700, 600, 3), np.uint8)
        depth = np.linspace(1, 2, 700 * 600, dtype=np.float32).reshape(700, 600)
        header, *chunks = messages_of(viewloom.Source(color[:, ::-1], depth, fov_y_rad=1))
        joined = {0: b"", 1: b""}
        for chunk in (message.chunk for message in chunks):
            self.assertEqual(chunk.offset_bytes, len(joined[chunk.plane_index]))
            self.assertLessEqual(len(chunk.data), CHUNK_BYTES_MAX)
            joined[chunk.plane_index] += chunk.data
        self.assertEqual(joined[0], color[:, ::-1].tobytes())
        self.assertEqual(joined[1], depth.tobytes())
        sizes = [plane.bytes_count for plane in header.header.sources[0].layers[0].planes]
        self.assertEqual(sizes, [700 * 600 * 3, 700 * 600 * 4])

    def test_types_of_arrays_become_encodings(self):
        floats = np.full((4, 6, 3), 0.25)
        for color, depth, encodings in (
                (COLOR, DEPTH, ("RGB8", "DEPTH_F32")),
                (np.zeros((4, 6, 4), np.uint8), DEPTH.astype(">f8"), ("RGBA8", "DEPTH_F32")),
                (floats, DEPTH.astype(np.float16), ("RGBA16F", "DEPTH_F16"))):
            planes = planes_of(viewloom.Source(color, depth, fov_y_rad=1))
            self.assertEqual([frame_pb2.PlaneEncoding.Name(plane.encoding) for plane in planes],
                             [f"PLANE_ENCODING_{name}" for name in encodings])
        color = messages_of(viewloom.Source(floats, DEPTH, fov_y_rad=1))[1].chunk.data
        self.assertEqual(np.frombuffer(color, "<f2").reshape(4, 6, 4)[2, 3].tolist(),
                         [0.25, 0.25, 0.25, 1])

    def test_coded_colour_travels_as_it_is(self):
        video = bytes(range(256)) * 5
        messages = messages_of(viewloom.Source(viewloom.CodedColor(video, (640, 481)), DEPTH,
                                               fov_y_rad=1.0), zstd_level=3)
        color, depth = messages[0].header.sources[0].layers[0].planes
        self.assertEqual(color.encoding, frame_pb2.PLANE_ENCODING_H264)
        self.assertEqual(color.compression, frame_pb2.PLANE_COMPRESSION_UNSPECIFIED)
        self.assertEqual((color.size.width, color.size.height, color.bytes_count),
                         (640, 481, len(video)))
        self.assertEqual(depth.compression, frame_pb2.PLANE_COMPRESSION_ZSTD)
        self.assertEqual(messages[1].chunk.data, video)
        jpeg, _ = planes_of(viewloom.Source([viewloom.CodedColor(b"ab", (6, 4), "jpeg")], [DEPTH],
                                            fov_y_rad=1.0))
        self.assertEqual(jpeg.encoding, frame_pb2.PLANE_ENCODING_JPEG)

    def test_words_become_what_the_planes_declare(self):
        color, depth = planes_of(viewloom.Source(
            np.zeros((2, 3, 4), np.uint8), DEPTH, fov_y_rad=1, transfer="linear",
            primaries="display_p3", alpha="straight"))
        self.assertEqual((color.transfer, color.primaries, color.alpha),
                         (frame_pb2.COLOR_TRANSFER_LINEAR, frame_pb2.COLOR_PRIMARIES_DISPLAY_P3,
                          frame_pb2.ALPHA_MODE_STRAIGHT))
        self.assertEqual((color.size.width, color.size.height), (3, 2))
        self.assertEqual((depth.size.width, depth.size.height), (6, 4))
        self.assertEqual(depth.depth.meaning, frame_pb2.DEPTH_MEANING_PLANAR)

    def test_displays_come_as_names_mappings_and_messages(self):
        message = display_pb2.Display(quilt={"preset": "portrait"})
        for display in ({"quilt": {"preset": "portrait"}}, message):
            self.assertEqual(display_from(display), message)
        self.assertEqual(display_from("portrait"), display_pb2.Display(preset="portrait"))

    def test_depth_in_other_units_says_so(self):
        planes = planes_of(viewloom.Source(
            COLOR, DEPTH.astype(np.uint16), fov_y_rad=1,
            depth_format={"meaning": "DEPTH_MEANING_PLANAR", "scale": 0.001, "invalid_value": 0}))
        self.assertEqual(planes[1].encoding, frame_pb2.PLANE_ENCODING_DEPTH_U16)
        self.assertEqual((planes[1].depth.scale, planes[1].depth.invalid_value), (0.001, 0))
        self.assertTrue(planes[1].depth.HasField("invalid_value"))

    def test_a_field_of_view_follows_the_shape(self):
        camera = messages_of(viewloom.Source(COLOR, DEPTH, fov_y_rad=1))[0].header.sources[0].camera
        self.assertAlmostEqual(camera.fov.angle_up_rad, 0.5)
        self.assertAlmostEqual(math.tan(camera.fov.angle_right_rad), math.tan(0.5) * 6 / 4)

    def test_matrices_become_the_same_turns(self):
        # About each axis and about a slanted one, by angles on both sides of a half turn.
        for axis in np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [2, -1, 3]]) / 1.0:
            axis /= np.linalg.norm(axis)
            cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]],
                              [-axis[1], axis[0], 0]])
            for angle_rad in (0.0, 0.3, 2.0, math.pi, 4.0):
                matrix = np.eye(4)  # Rodrigues
                matrix[:3, :3] += (math.sin(angle_rad) * cross
                                   + (1 - math.cos(angle_rad)) * cross @ cross)
                matrix[:3, 3] = 1, 2, 3
                pose = pose_from(matrix)
                got = np.array([getattr(pose.orientation, name) for name in "xyzw"])
                want = np.append(math.sin(angle_rad / 2) * axis, math.cos(angle_rad / 2))
                self.assertAlmostEqual(abs(got @ want), 1, places=12)
                self.assertEqual((pose.position.x, pose.position.y, pose.position.z), (1, 2, 3))


class Imports(unittest.TestCase):
    def test_the_messages_alone_need_no_numpy(self):
        program = ("import sys, viewloom.v1.display_service_pb2_grpc\n"
                   "sys.exit(bool({'numpy', 'zstandard', 'PIL'} & set(sys.modules)))")
        self.assertEqual(subprocess.run([sys.executable, "-c", program], check=False).returncode, 0)

    def test_every_name_is_there(self):
        for name in viewloom.__all__:
            self.assertTrue(getattr(viewloom, name).__doc__, name)
        with self.assertRaisesRegex(AttributeError, "no attribute 'conect'"):
            viewloom.conect


if __name__ == "__main__":
    unittest.main()
