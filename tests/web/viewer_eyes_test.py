# SPDX-License-Identifier: Apache-2.0
"""Tracked displays over WebSocket, watched by a client that shares no code with the server."""
import io
import struct
import sys
import unittest
import zlib

from PIL import Image

from web_client import Server, WebSocket, asked, decode_code, fetch, quilt

PROGRAM = sys.argv.pop(1)


def poses(*positions, time_ns="1"):
    return {"eye_poses": {"time_ns": time_ns,
                          "eyes": [{"pose": {"position": place}} for place in positions]}}


class ViewerEyes(unittest.TestCase):
    def setUp(self):
        self.serve()

    def serve(self, *options):
        self.server = Server(PROGRAM, "--idle-ms", 60_000, *options)
        self.addCleanup(self.server.__exit__)

    def watch(self, display, encoding=None):
        viewer = WebSocket(self.server.port, "/ws?" + asked(display, encoding))
        self.assertTrue(viewer.is_open, viewer.reply and viewer.reply.body)
        self.addCleanup(viewer.close)
        return viewer

    def tracked(self, layout="SINGLE", **encoding):
        display = {"stereo": {"layout": f"STEREO_LAYOUT_{layout}", "tracked": True,
                              "eye_size": {"width": 160, "height": 120}}}
        return self.watch(display, encoding or None)

    def test_an_eye_is_followed_and_its_pictures_say_which_pose_they_show(self):
        viewer = self.tracked()
        first = viewer.receive_atlas()
        viewer.shown(first)
        self.assertNotIn("eyes", first.header)
        self.assertEqual(first.header["layout"]["view_count"], 1)
        for x_m, view in ((-0.6, 3), (0.0, 24), (0.6, 44)):
            viewer.send_json(poses({"x": x_m}, time_ns=str(2 ** 60)))
            atlas = viewer.receive_atlas()
            viewer.shown(atlas)
            self.assertEqual(atlas.header["eyes"]["time_ns"], str(2 ** 60))
            layout = atlas.header["layout"]
            self.assertEqual(layout["views"][0]["pose"]["position"], {"x": x_m, "y": 0, "z": 0})
            self.assertAlmostEqual(decode_code(Image.open(io.BytesIO(atlas.jpeg))), view, delta=1)
        viewer.send_json({"clock_probe": {"client_time_ns": "17"}})
        clock = viewer.receive()["clock"]
        self.assertEqual(clock["client_time_ns"], "17")
        self.assertGreaterEqual(int(clock["server_sent_ns"]), int(clock["server_received_ns"]))

    def test_poses_stay_with_their_eye_through_a_change_of_size(self):
        viewer = self.tracked()
        viewer.shown(viewer.receive_atlas())
        viewer.send_json(poses({"x": 0.6}, time_ns="5"))
        viewer.shown(viewer.receive_atlas())
        viewer.send_json({"change": {"display": {"stereo": {
            "layout": "STEREO_LAYOUT_SINGLE", "tracked": True,
            "eye_size": {"width": 80, "height": 60}}}}})
        changed = viewer.receive_atlas()
        self.assertEqual(changed.header["layout"]["size"], {"width": 80, "height": 60})
        self.assertEqual(changed.header["eyes"]["time_ns"], "5")

    def test_a_change_of_size_needs_no_second_place(self):
        self.serve("--displays", 1)
        viewer = self.tracked()
        viewer.shown(viewer.receive_atlas())
        for width in (80, 120, 160):
            viewer.send_json({"change": {"display": {"stereo": {
                "layout": "STEREO_LAYOUT_SINGLE", "tracked": True,
                "eye_size": {"width": width, "height": 60}}}}})
            changed = viewer.receive_atlas()
            self.assertEqual(changed.header["layout"]["size"], {"width": width, "height": 60})
            viewer.shown(changed)

    def test_eyes_of_two_viewers_do_not_meet(self):
        viewers = [self.tracked() for _ in range(3)]
        for viewer in viewers:
            viewer.shown(viewer.receive_atlas())
        for number, viewer in enumerate(viewers):
            viewer.send_json(poses({"x": 0.1 * number}))
        for number, viewer in enumerate(viewers):
            position = viewer.receive_atlas().header["layout"]["views"][0]["pose"]["position"]
            self.assertAlmostEqual(position["x"], 0.1 * number)
        displays = fetch(self.server.port, "/api/displays").json()["displays"]
        self.assertEqual([display["subscriber_count"] for display in displays], [1, 1, 1])

    def test_poses_that_see_nothing_are_refused_and_the_eye_goes_on(self):
        viewer = self.tracked()
        viewer.shown(viewer.receive_atlas())
        place = "eye_poses.eyes[0].pose.position"
        for bad, field in (
                (poses({"x": "NaN"}), place), (poses({"x": 1e12}), place),
                (poses({"z": -3}), place + ".z"), (poses({}, {}), "eye_poses.eyes"),
                ({"eye_poses": {"eyes": []}}, "eye_poses.eyes"),
                ({"eye_poses": {"eyes": 3}}, "eye_poses.eyes")):
            viewer.send_json(bad)
            self.assertEqual(viewer.receive()["error"]["field"], field, bad)
        viewer.send_json(poses({"x": 0.5}))
        self.assertIn("eyes", viewer.receive_atlas().header)
        fixed = self.watch(quilt(4, 2, 320, 160))
        fixed.shown(fixed.receive_atlas())
        fixed.send_json(poses({"x": 0}))
        self.assertEqual(fixed.receive()["error"]["code"], "FAILED_PRECONDITION")

    def test_stills_and_players_have_no_eyes(self):
        tracked = asked({"stereo": {"tracked": True, "eye_size": {"width": 8, "height": 8}}},
                        stream=None)
        for path in ("/still/painted.jpg?", "/stream/painted.mjpg?"):
            refused = fetch(self.server.port, path + tracked).json()["error"]
            self.assertEqual(refused["field"], "display.stereo.tracked")

    def test_compact_depth_is_a_quarter_of_the_samples_in_listed_bands(self):
        atlas = self.tracked(with_depth=True,
                             planes="BAND_ENCODING_COMPACT_DEPTH").receive_atlas()
        (band,) = atlas.header["depth_bands"]
        self.assertEqual(band, {"first_row": 0, "row_count": 120, "bytes": len(atlas.depth)})
        (step,) = struct.unpack_from("<f", atlas.depth)
        residuals = zlib.decompress(atlas.depth[4:])
        self.assertEqual(len(residuals), 2 * 80 * 60)
        # The first row of blocks: each is predicted by the one to its left.
        code, values = 0, []
        for x in range(80):
            written = residuals[x] | residuals[80 * 60 + x] << 8
            code += -(written + 1) // 2 if written & 1 else written // 2
            values.append(code * step)
        for x, inv_z in ((0, 0.25), (40, 0.625), (79, 1)):
            self.assertAlmostEqual(values[x], inv_z, delta=0.01)


if __name__ == "__main__":
    unittest.main()
