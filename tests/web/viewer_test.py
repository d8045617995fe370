# SPDX-License-Identifier: Apache-2.0
"""Atlases over WebSocket, taken by a client that shares no code with the server."""
import io
import os
import struct
import sys
import time
import unittest

from PIL import Image

from web_client import Server, WebSocket, asked, decode_view, fetch, quilt

PROGRAM = sys.argv.pop(1)
SMALL_QUILT = quilt(4, 2, 320, 160)
SMALL = "/ws?" + asked(SMALL_QUILT)


def small(**fields):
    return quilt(4, 2, 320, 160, **fields)


def change(**fields):
    return {"change": {"display": small(**fields)}}
THREAD_COUNT = 2  # of the web server


class Viewers(unittest.TestCase):
    def setUp(self):
        # Viewers that answer no ping must stay for the whole test, even on a slow machine.
        self.server = Server(PROGRAM, "--thread-count", THREAD_COUNT, "--idle-ms", 60_000)
        self.addCleanup(self.server.__exit__)

    def watch(self, target=SMALL, headers=None):
        viewer = WebSocket(self.server.port, target, headers)
        self.assertTrue(viewer.is_open, viewer.reply and viewer.reply.body)
        self.addCleanup(viewer.close)
        return viewer

    def test_an_atlas_is_one_jpeg_and_its_whole_truth(self):
        display = small(view_cone_rad=0.5235987755982988, focal_distance_m=1.5)
        atlas = self.watch("/ws?" + asked(display, {"jpeg_quality": 70})).receive_atlas()
        header = atlas.header
        self.assertEqual((header["sequence"], header["delivery"], header["frame_number"]),
                         (1, 1, "1"))
        layout = header["layout"]
        self.assertEqual((layout["columns"], layout["rows"], layout["view_count"]), (4, 2, 8))
        self.assertEqual(layout["size"], {"width": 320, "height": 160})
        self.assertEqual(layout["order"], "BOTTOM_LEFT")
        self.assertAlmostEqual(layout["view_cone_rad"], 0.5235987755982988)
        self.assertEqual(layout["focal_distance_m"], 1.5)
        self.assertEqual(header["encoding"], {"jpeg_quality": 70, "chroma": "420"})
        self.assertEqual(header["times"]["trace_ns"], 70_000_000)
        self.assertAlmostEqual(sum(header["coverage"].values()), 1)
        image = Image.open(io.BytesIO(atlas.jpeg))
        self.assertEqual([decode_view(image, layout, view) for view in range(8)], list(range(8)))

    def test_depth_comes_behind_the_picture_when_asked(self):
        self.assertEqual(self.watch().receive_atlas().depth, b"")
        with_depth = "/ws?" + asked(SMALL_QUILT, {"with_depth": True})
        atlas = self.watch(with_depth).receive_atlas()
        values = struct.unpack(f"<{320 * 160}f", atlas.depth)
        for x, expected in ((0, 0.25), (40, 0.625), (79, 1), (80, 0.25)):  # tiles are 80 px wide
            self.assertAlmostEqual(values[100 * 320 + x], expected, delta=0.01)
        with Image.open(io.BytesIO(atlas.jpeg)) as image:
            self.assertEqual(image.size, (320, 160))
        wrong = "/ws?" + asked(SMALL_QUILT, {"with_depth": 2})
        refused = WebSocket(self.server.port, wrong).reply.json()["error"]
        self.assertEqual(
            (refused["field"], refused["message"]),
            ("encoding.with_depth", "encoding.with_depth: got 2; accepted is true or false"))

    def test_a_joiner_on_a_still_stream_gets_the_newest_atlas(self):
        first = self.watch().receive_atlas()
        second = self.watch().receive_atlas()
        self.assertEqual(first.header["sequence"], second.header["sequence"])
        self.assertEqual(first.jpeg, second.jpeg)

    def test_who_shows_nothing_gets_two_and_then_only_the_newest(self):
        slow, fast = self.watch(), self.watch()
        slow_first = slow.receive_atlas()
        fast.shown(fast.receive_atlas())
        for expected in range(2, 12):
            self.server.command("frame")
            atlas = fast.receive_atlas()
            self.assertEqual(atlas.header["sequence"], expected)
            self.assertEqual(atlas.header["dropped_count"], 0)
            fast.shown(atlas)
            if expected == 2:
                slow_second = slow.receive_atlas()  # on its way before a third could replace it
        slow.shown(slow_first)
        newest = slow.receive_atlas()
        self.assertEqual(slow_second.header["sequence"], 2)
        # The fast viewer may be handed the last one a moment before the slow one.
        self.assertIn(newest.header["sequence"], (10, 11))
        self.assertEqual(newest.header["dropped_count"], newest.header["sequence"] - 3)
        self.assertGreater(newest.header["shown_ns"], 0)

    def test_two_hundred_viewers_cost_no_thread_and_a_deaf_one_costs_nobody(self):
        deaf = self.watch("/ws?stream=painted")  # 3360 x 3360: more than a socket holds; never read
        threads = self.server.status_field("Threads")
        viewers = [self.watch() for _ in range(200)]
        for viewer in viewers:
            viewer.shown(viewer.receive_atlas())
        # One that waited for its end when they were counted may have gone since.
        self.assertLessEqual(self.server.status_field("Threads"), threads)
        for expected in range(2, 6):
            self.server.command("frame")
            for viewer in viewers:
                atlas = viewer.receive_atlas()
                self.assertEqual(atlas.header["sequence"], expected)
                viewer.shown(atlas)
        self.assertLessEqual(self.server.status_field("Threads"), threads)
        displays = fetch(self.server.port, "/api/displays").json()["displays"]
        self.assertEqual(sorted(display["subscriber_count"] for display in displays), [1, 200])
        self.assertIsNone(deaf.close_code)

    def test_a_change_gives_another_display_and_a_bad_one_keeps_the_old(self):
        viewer = self.watch()
        viewer.shown(viewer.receive_atlas())
        viewer.send_json(change(focal_distance_m=0.5, view_cone_rad=0.35))
        changed = viewer.receive_atlas()
        viewer.shown(changed)
        self.assertEqual(changed.header["layout"]["focal_distance_m"], 0.5)
        self.assertEqual(changed.header["layout"]["columns"], 4)
        self.assertEqual(changed.header["delivery"], 2)
        viewer.send_json(change(focal_distance_m=-1))
        self.assertEqual(viewer.receive()["error"]["field"],
                         "change.display.quilt.focal_distance_m")
        viewer.send_json(change(focal_distance=1))
        self.assertEqual(viewer.receive()["error"]["message"].rsplit("; ", 1)[1],
                         'did you mean "focal_distance_m"?')
        viewer.send_json({"change": {"encoding": {"jpeg_quality": 60}}})
        packed = viewer.receive_atlas()
        viewer.shown(packed)
        self.assertEqual(packed.header["encoding"]["jpeg_quality"], 60)
        self.server.command("frame")
        kept = viewer.receive_atlas()
        viewer.shown(kept)
        self.assertEqual(kept.header["layout"]["focal_distance_m"], 0.5)
        viewer.send_json({"change": {"display": SMALL_QUILT}})
        self.assertEqual(viewer.receive_atlas().header["layout"]["focal_distance_m"], 2)
        self.assertEqual(len(fetch(self.server.port, "/api/displays").json()["displays"]), 1)

    def test_a_change_is_counted_in_the_atlases_that_follow_it(self):
        viewer = self.watch()
        first = viewer.receive_atlas()
        viewer.shown(first)
        viewer.send_json(change(focal_distance_m=0.5))
        second = viewer.receive_atlas()
        viewer.shown(second)
        viewer.send_json(change(focal_distance_m="far"))  # in vain, and yet asked for
        self.assertEqual(viewer.receive()["error"]["field"],
                         "change.display.quilt.focal_distance_m")
        self.server.command("frame")
        third = viewer.receive_atlas()
        self.assertEqual([atlas.header["change_count"] for atlas in (first, second, third)],
                         [0, 1, 2])

    def test_a_part_of_the_cone_is_the_views_of_the_whole_that_stand_there(self):
        def part(**fields):
            return "/ws?" + asked(quilt(5, 1, 400, 107, preset="portrait", **fields))
        atlas = self.watch(part(cone_begin=20 / 48, cone_end=25 / 48)).receive_atlas()
        layout = atlas.header["layout"]
        self.assertEqual((layout["view_count"], layout["cone_begin"], layout["cone_end"]),
                         (5, 20 / 48, 25 / 48))
        image = Image.open(io.BytesIO(atlas.jpeg))
        self.assertEqual([decode_view(image, layout, view) for view in range(5)],
                         list(range(20, 25)))
        for wrong, field in (({"cone_begin": -0.1}, "cone_begin"), ({"cone_end": 1.1}, "cone_end"),
                             ({"cone_begin": 0.6, "cone_end": 0.5}, "cone_end"),
                             ({"cone_begin": "NaN"}, "cone_begin")):
            refused = WebSocket(self.server.port, part(**wrong))
            self.addCleanup(refused.close)
            self.assertEqual(refused.reply.json()["error"]["field"], "display.quilt." + field)

    def test_a_viewer_that_asks_whether_the_server_is_there_is_answered(self):
        viewer = self.watch()
        viewer.receive_atlas()  # and stands: nothing else would be sent
        for number in (0, 7, 2**63):
            viewer.send_json({"ping": number})
            self.assertEqual(viewer.receive(), {"pong": number})

    def test_a_viewer_that_answers_no_ping_is_gone_and_one_that_does_stays(self):
        with Server(PROGRAM, "--idle-ms", 400) as server:
            deaf = WebSocket(server.port, SMALL)
            awake = WebSocket(server.port, "/ws?" + asked(small(focal_distance_m=1)))
            for viewer in (deaf, awake):
                self.addCleanup(viewer.close)
                viewer.receive_atlas()
            displays = None
            while displays != 1:  # the display of the deaf one goes with it
                awake.send_json({"ping": 1})
                self.assertEqual(awake.receive(), {"pong": 1})
                displays = len(fetch(server.port, "/api/displays").json()["displays"])

    def test_a_viewer_that_never_reads_is_cut_whatever_it_sends(self):
        with Server(PROGRAM, "--transfer-ms", 500) as server:
            deaf = WebSocket(server.port, "/ws?stream=painted")  # more than a socket holds
            self.addCleanup(deaf.close)
            begun_s = time.monotonic()
            with self.assertRaises((BrokenPipeError, ConnectionResetError)):
                while time.monotonic() < begun_s + 30:
                    deaf.send_json({"shown": 0})
                    time.sleep(0.1)

    def test_messages_that_mean_nothing_are_answered_with_what_is_accepted(self):
        viewer = self.watch()
        viewer.shown(viewer.receive_atlas())
        for payload, field in ((b"", "message"), (b"{", "message"), (b"[]", "message"),
                               (b"17", "message"), (b'"shown"', "message"), (b"{}", "message"),
                               (b'{"shown": -1}', "shown"), (b'{"shown": 1e99}', "shown"),
                               (b'{"shown": 1, "change": {}}', "message"),
                               (b'{"shown": 1, "shown": 1}', "shown"),
                               (b'{"change": 5}', "change"), (b'{"other": 1}', "other"),
                               (b'{"change": {"display": {"quilt": []}}}', "change.display.quilt"),
                               (b"[" * 60_000, "message")):
            with self.subTest(payload[:30]):
                viewer.send_frame(WebSocket.TEXT, payload)
                self.assertEqual(viewer.receive()["error"]["field"], field)
        viewer.send_json({"shown": 2**63})
        self.server.command("frame")
        self.assertEqual(viewer.receive_atlas().header["sequence"], 2)

    def test_a_message_over_the_limit_ends_the_connection(self):
        viewer = self.watch()
        viewer.shown(viewer.receive_atlas())
        viewer.send_frame(WebSocket.TEXT, b" " * 60_000, is_last=False)
        viewer.send_frame(WebSocket.CONTINUATION, b" " * 60_000, is_last=False)
        viewer.send_frame(WebSocket.CONTINUATION, b" " * 60_000)
        self.assertIsNone(viewer.receive())
        self.assertEqual(viewer.close_code, 1009)

    def test_a_display_that_cannot_be_served_says_why(self):
        viewer = self.watch()
        viewer.shown(viewer.receive_atlas())
        self.server.command("refuse")
        self.assertEqual(viewer.receive()["error"]["field"], "quilt.size")
        self.assertIsNone(viewer.receive())
        self.assertEqual(viewer.close_code, 1008)

    def test_a_draining_server_says_that_it_goes(self):
        viewers = [self.watch() for _ in range(5)]
        deaf = self.watch("/ws?stream=painted")
        for viewer in viewers:
            viewer.receive_atlas()
        self.server.process.stdin.close()
        for viewer in viewers:
            self.assertIsNone(viewer.receive())
            self.assertEqual(viewer.close_code, 1001)
        self.assertEqual(self.server.process.wait(60), 0)
        self.assertIsNone(deaf.close_code)

    def test_a_page_of_the_server_itself_may_watch(self):
        host = f"localhost:{self.server.port}"
        viewer = self.watch(headers={"Host": host, "Origin": f"http://{host}"})
        self.assertEqual(viewer.receive_atlas().header["sequence"], 1)

    @unittest.skipIf(os.environ.get("VIEWLOOM_SANITIZE"), "sanitizers keep what was freed")
    def test_memory_stays_while_viewers_come_and_go(self):
        def come_and_go():
            for _ in range(100):
                viewer = self.watch()
                viewer.receive_atlas()
                viewer.close()
        come_and_go()
        before_kib = self.server.status_field("VmRSS")
        come_and_go()
        # 100 viewers that each left their 30 KiB atlas or their coroutines behind would show.
        self.assertLess(self.server.status_field("VmRSS") - before_kib, 2000)


if __name__ == "__main__":
    unittest.main()
