# SPDX-License-Identifier: Apache-2.0
"""Atlases of a real server as numpy arrays, while frames come, and what it refuses."""

import json
import math
import time
import unittest
import urllib.request
from concurrent import futures

import viewloomd  # takes its argument

import grpc
import numpy as np

import scene
import viewloom
from viewloom.v1 import atlas_pb2, display_pb2, display_service_pb2_grpc, geometry_pb2

LOSSLESS = viewloom.encoding(lossless=True)
FRAMES = 8


def flat_source(level):
    color = np.full((scene.HEIGHT_PX, scene.WIDTH_PX, 3), level, np.uint8)
    return scene.source(color, scene.step_depth())


class Watching(unittest.TestCase):
    def setUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.server = viewloom.connect(self.daemon.address)
        self.addCleanup(self.daemon.stop)
        self.addCleanup(self.server.close)

    def refused(self, call, status, field, words):
        with self.assertRaises(viewloom.ViewloomError) as refusal:
            call()
        error = refusal.exception
        self.assertEqual((error.status.name, error.field), (status, field), error)
        self.assertIn(words, error.message)
        self.assertFalse(error.message.startswith(field + ":") and field)

    def test_a_slow_reader_gets_the_newest_and_is_told_what_it_missed(self):
        with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.own_place(), encoding=LOSSLESS) as watcher:
            publisher.send(flat_source(0))
            first = watcher.receive(viewloomd.PATIENCE_S)
            for number in range(2, FRAMES + 1):
                publisher.send(flat_source(number * 20)).result(viewloomd.PATIENCE_S)
            received = [first]
            while received[-1].header.frame_number < FRAMES:
                received.append(watcher.receive(viewloomd.PATIENCE_S))
            for atlas in received[1:]:
                np.testing.assert_array_equal(atlas.color, atlas.header.frame_number * 20)
            for before, after in zip(received, received[1:]):
                self.assertEqual(after.skipped,
                                 after.header.sequence - before.header.sequence - 1)
            self.assertLess(len(received), FRAMES)

    def test_changes_are_followed_by_another_layout(self):
        with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.quilt(2, 1)) as watcher:
            publisher.send(flat_source(90))
            self.assertEqual(next(watcher).layout.view_count, 2)
            watcher.change(scene.quilt(3, 2), LOSSLESS)
            atlas = next(atlas for atlas in watcher if atlas.layout.view_count == 6)
            self.assertEqual(atlas.layout.encoding.color, atlas_pb2.BAND_ENCODING_ZSTD)
            self.assertEqual(atlas.color.shape, (2 * scene.HEIGHT_PX, 3 * scene.WIDTH_PX, 3))
            with self.assertRaisesRegex(viewloom.BadInput, "no file; use color"):
                atlas.jpeg
            with self.assertRaisesRegex(viewloom.BadInput, "did not come"):
                atlas.inv_z

    def test_views_lie_where_their_order_says(self):
        """A seam on the wall, in front of the focal plane or behind it, moves with the eye."""
        color = np.full((scene.HEIGHT_PX, scene.WIDTH_PX, 3), (30, 60, 210), np.uint8)
        color[:, :scene.WIDTH_PX // 2] = (220, 40, 30)
        depth_m = np.full(color.shape[:2], 2.0)
        eyes_m = [-0.4, -0.1, 0.2, 0.3, 0.5]
        displays = [scene.cameras(eyes_m, columns=2)]
        displays.append(scene.quilt(2, 3, view_count=5, focal_distance_m=1.0,
                                    size={"width": 2 * scene.WIDTH_PX + 1,
                                          "height": 3 * scene.HEIGHT_PX + 2}))
        with self.server.publish("scene") as publisher:
            publisher.send(scene.source(color, depth_m)).result(viewloomd.PATIENCE_S)
            top_left, bottom_left = [self.server.still("scene", display, encoding=LOSSLESS)
                                     for display in displays]
        self.assertEqual(top_left.layout.order, display_pb2.TILE_ORDER_TOP_LEFT)
        self.assertEqual(bottom_left.layout.order, display_pb2.TILE_ORDER_BOTTOM_LEFT)
        self.assertEqual(bottom_left.layout.padding_top_px, 2)
        for atlas in (top_left, bottom_left):
            for view in range(5):
                camera = atlas.layout.views[view]
                eye_m = camera.pose.position.x
                focal_px = camera.intrinsics.focal_x_px or scene.WIDTH_PX / 2 / 0.8
                axis_px = camera.intrinsics.principal_x_px or scene.WIDTH_PX / 2
                row = atlas.view(view)[scene.HEIGHT_PX // 2].astype(int)
                seam_px = np.count_nonzero(row[:, 0] > row[:, 2])
                self.assertAlmostEqual(seam_px, axis_px - eye_m / 2.0 * focal_px, delta=1.5,
                                       msg=f"view {view} of {atlas.layout.suffix or 'cameras'}")
        self.assertEqual([round(view.pose.position.x, 3) for view in top_left.layout.views], eyes_m)

    def test_a_preset_is_a_display_and_its_still_is_that_of_the_page(self):
        with self.server.publish("scene") as publisher:
            publisher.send(scene.source(scene.noise_color(), scene.step_depth())).result(
                viewloomd.PATIENCE_S)
            still = self.server.still("scene", "portrait", timeout_s=viewloomd.PATIENCE_S)
            self.assertEqual(still.layout.view_count, 48)
            self.assertEqual(still.view(47).shape, (560, 420, 3))
            direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))
            with direct.open(self.daemon.url + "still/scene/portrait") as reply:
                self.assertEqual(reply.read(), still.jpeg)

    def test_panels_come_as_channels_and_views_as_images_of_their_own(self):
        panel = {"lenticular": {"calibration_json": json.dumps(
            {"pitch": 40, "slope": -6.5, "center": 0.3, "DPI": 320, "screenW": 96, "screenH": 70})}}
        apart = scene.cameras([-0.1, 0.0, 0.1], columns=0)
        apart["cameras"]["arrangement"] = "TILE_ARRANGEMENT_SEPARATE_VIEWS"
        with self.server.publish("scene") as publisher:
            publisher.send(scene.source(scene.noise_color(), scene.step_depth())).result(
                viewloomd.PATIENCE_S)
            usual, exact = [self.server.still("scene", panel, encoding=encoding)
                            for encoding in (viewloom.encoding(jpeg_quality=100), LOSSLESS)]
            views = self.server.still("scene", apart, encoding=LOSSLESS)
        self.assertEqual(usual.layout.encoding.color, atlas_pb2.BAND_ENCODING_JPEG_PLANES)
        self.assertEqual(usual.color.shape, (70, 96, 3))
        self.assertLess(np.abs(usual.color.astype(int) - exact.color).max(), 6)
        self.assertEqual(views.image_count, 3)
        np.testing.assert_array_equal(views.view(1), views.plane(atlas_pb2.ATLAS_PLANE_COLOR, 1))
        np.testing.assert_array_equal(views.view(1), scene.noise_color())

    def test_eyes_that_move_see_what_fixed_ones_in_their_place_do(self):
        size = {"width": scene.WIDTH_PX, "height": scene.HEIGHT_PX}
        tracked = {"stereo": {"eye_size": size, "tracked": True, "focal_distance_m": scene.FAR_M}}
        with self.server.publish("scene") as publisher, \
                self.server.watch("scene", tracked, encoding=LOSSLESS,
                                  wait_for_stream=True) as watcher:
            publisher.send(scene.source(scene.noise_color(), scene.step_depth()))
            self.assertEqual(next(watcher).header.eye_poses_time_ns, 0)
            pairs = [((-0.2, 0, 0), (0.1, 0, 0)), (np.array([0.5, 0.1, 0.2]), [0.6, 0.1, 0])]
            for time_ns, (left, right) in enumerate(pairs, 1):
                watcher.send_eye_poses(left, right, time_ns=time_ns, predicted_display_time_ns=9)
                atlas = watcher.receive(viewloomd.PATIENCE_S)
                self.assertEqual(atlas.header.eye_poses_time_ns, time_ns)
                self.assertEqual(atlas.header.predicted_display_time_ns, 9)
                self.assertEqual(atlas.layout.views[0].pose.position.x, left[0])
                fixed = display_pb2.Display(stereo=display_pb2.StereoDisplay(
                    eye_size=size, eyes=atlas.layout.views))
                still = self.server.still("scene", fixed, encoding=LOSSLESS)
                np.testing.assert_array_equal(atlas.color, still.color)
            own = geometry_pb2.Camera(fov=scene.fov_mapping())
            watcher.send_eye_poses(own, own)
            np.testing.assert_array_equal(watcher.receive(viewloomd.PATIENCE_S).view(1),
                                          scene.noise_color())
            with self.assertRaisesRegex(viewloom.BadInput, "right: is .*, must be x, y, z"):
                watcher.send_eye_poses((0, 0, 0), (0, 0))
            watcher.send_eye_poses((0, 0, 0), (0, 0, -scene.FAR_M))
            self.refused(lambda: watcher.receive(viewloomd.PATIENCE_S), "INVALID_ARGUMENT",
                         "eye_poses.eyes[1].pose.position.z", "focal plane")

    def test_the_servers_clock_is_this_machines(self):
        """Both count the same nanoseconds here, so the offset is 0 to within its error."""
        with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.own_place()) as watcher:
            publisher.send(flat_source(90))
            atlas = next(watcher)
            before_ns = time.monotonic_ns()
            clock = watcher.measure_clock(timeout_s=viewloomd.PATIENCE_S)
            took_ns = time.monotonic_ns() - before_ns
            self.assertGreater(clock.error_ns, 0)
            self.assertLess(clock.error_ns, took_ns)
            self.assertLessEqual(abs(clock.ahead_ns), clock.error_ns)
            watcher.report_presented(atlas, time.monotonic_ns())
        with self.assertRaisesRegex(viewloom.ViewloomError, "over"):
            watcher.measure_clock()

    def test_a_source_is_advised(self):
        # Two eyes of a focal plane 2 m away where all of the scene is, framed 30 degrees high.
        pair = display_pb2.Display(quilt=display_pb2.QuiltDisplay(
            columns=2, rows=1, size={"width": 200, "height": 100}, view_cone_rad=0.7,
            focal_distance_m=2, fov_y_rad=math.pi / 6))
        advice = self.server.advise_source(pair, 2, 2)
        size, pinhole = advice.size, advice.camera.intrinsics
        self.assertAlmostEqual(2 * math.atan(size.height / 2 / pinhole.focal_y_px), math.pi / 6)
        self.assertEqual((size.width, advice.layer_count), (size.height, 2))
        deep = self.server.advise_source({"quilt": {"preset": "portrait", "fov_y_rad": 0.25}},
                                         0.3, 1000)
        self.assertEqual(deep.layer_count, 3)
        self.assertGreater(abs(deep.second_source.pose.position.x), 0)
        self.refused(lambda: self.server.advise_source("portrait", 1, 2), "INVALID_ARGUMENT",
                     "display.quilt.fov_y_rad", "stream")
        self.refused(lambda: self.server.advise_source(pair, 2, 1), "INVALID_ARGUMENT", "far_m",
                     "1")

    def test_refusals_name_the_field(self):
        with self.server.publish("scene") as publisher:
            bad_quilt = scene.quilt(0, 2)
            self.refused(lambda: self.server.still("scene", bad_quilt), "INVALID_ARGUMENT",
                         "open.display.quilt.columns", "0")
            with self.server.watch("scene", bad_quilt) as watcher:
                self.refused(watcher.receive, "INVALID_ARGUMENT", "open.display.quilt.columns", "0")
            self.refused(lambda: self.server.still("elsewhere", "portrait"), "NOT_FOUND",
                         "open.stream", "scene")
            self.refused(lambda: self.server.still("scene", "no_such"), "NOT_FOUND",
                         "open.display.preset", "portrait")
            self.refused(lambda: self.server.publish("scene"), "ALREADY_EXISTS", "settings.stream",
                         "scene")
            self.refused(lambda: self.server.publish("no spaces"), "INVALID_ARGUMENT",
                         "settings.stream", "no spaces")
            self.refused(lambda: publisher.send(viewloom.Source(1, 2)), "INVALID_ARGUMENT",
                         "color", "int")  # here, so that the call goes on
            publisher.send(flat_source(1)).result(viewloomd.PATIENCE_S)

    def test_a_refused_frame_ends_the_call_and_says_why(self):
        publisher = self.server.publish("scene")
        pending = publisher.send(flat_source(1), exposure_ev=99)
        self.refused(lambda: pending.result(viewloomd.PATIENCE_S), "INVALID_ARGUMENT",
                     "header.exposure_ev", "-32..32")
        self.refused(lambda: publisher.send(flat_source(1)), "INVALID_ARGUMENT",
                     "header.exposure_ev", "99")
        self.refused(publisher.close, "INVALID_ARGUMENT", "header.exposure_ev", "99")

    def test_a_stream_is_taken_over_with_its_session(self):
        first = self.server.publish("scene", session_id="secret")
        with self.server.publish("scene", session_id="secret") as second:
            self.refused(first.close, "ABORTED", "", "")
            second.send(flat_source(1)).result(viewloomd.PATIENCE_S)

    def test_the_catalogue_tells_what_there_is(self):
        with self.server.publish("scene") as publisher, \
                self.server.watch("scene", scene.quilt(2, 1)) as watcher:
            publisher.send(flat_source(1)).result(viewloomd.PATIENCE_S)
            next(watcher)
            self.assertEqual([(s.name, s.live, s.frame_number) for s in self.server.streams()],
                             [("scene", True, 1)])
            self.assertEqual([d.stream for d in self.server.displays()], ["scene"])
            self.assertIn("portrait", [preset.name for preset in self.server.presets()])
            self.assertEqual(self.server.server_info().ingest_limits, publisher.accepted)
            self.assertEqual(publisher.wanted.display_count, 1)

    def test_waiting_has_an_end(self):
        with self.server.watch("later", "portrait", wait_for_stream=True) as watcher:
            self.refused(lambda: watcher.receive(timeout_s=0.01), "DEADLINE_EXCEEDED", "", "0.01 s")
        self.assertIsNone(watcher.receive(), "closed")
        self.assertEqual(list(watcher), [])
        self.refused(lambda: self.server.still("later", "portrait", wait_for_stream=True,
                                               timeout_s=0.05), "DEADLINE_EXCEEDED", "", "")

    def test_a_server_that_leaves_is_an_error_without_reconnecting(self):
        server = viewloom.connect(self.daemon.address, reconnect=False)
        self.addCleanup(server.close)
        publisher = server.publish("scene")
        watcher = server.watch("scene", "portrait")
        self.daemon.process.terminate()
        self.refused(watcher.receive, "UNAVAILABLE", "", "")
        self.refused(publisher.close, "UNAVAILABLE", "", "")


class Leaving(display_service_pb2_grpc.DisplayServiceServicer):
    """Ends calls as gRPC does with those that reach a server while it shuts down."""

    def StreamAtlases(self, request_iterator, context):
        context.abort(grpc.StatusCode.CANCELLED, "CANCELLED")
        yield


class CutOff(unittest.TestCase):
    def test_a_call_that_the_server_cancels_as_it_leaves_is_an_error_like_its_others(self):
        leaving = grpc.server(futures.ThreadPoolExecutor(2))
        display_service_pb2_grpc.add_DisplayServiceServicer_to_server(Leaving(), leaving)
        port = leaving.add_insecure_port("127.0.0.1:0")
        leaving.start()
        self.addCleanup(leaving.stop, None)
        with viewloom.connect(f"127.0.0.1:{port}") as server:
            for call in (lambda: server.still("scene", "portrait"),
                         server.watch("scene", "portrait").receive):
                with self.assertRaises(viewloom.ViewloomError) as end:
                    call()
                self.assertEqual(end.exception.status.name, "UNAVAILABLE", end.exception)


if __name__ == "__main__":
    unittest.main()
