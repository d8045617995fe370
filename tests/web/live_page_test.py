# SPDX-License-Identifier: Apache-2.0
"""The whole path: viewloom publishes its moving scene, viewloomd serves it, a browser shows it.
Arguments: viewloomd, viewloom. Screenshots are kept in the folder VIEWLOOM_SCREENSHOTS."""
import io
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from PIL import Image, ImageChops, ImageStat

from page_test import LIVE, PageTest, keep
from ray_server import RayServer
from web_client import TIMEOUT_S, WebSocket, asked, fetch, quilt

SERVER, CLIENT = sys.argv.pop(1), sys.argv.pop(1)
EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "..", "client", "examples")
QUILT = quilt(6, 2, 722, 323, aspect=0.75)
DISPLAY = asked(QUILT, stream="scene")
COLUMNS, ROWS, TILE = 6, 2, (120, 161)  # of DISPLAY; 2 px at the right and 1 at the top are padding
PADDING_TOP_PX = 1


def end(process):
    process.kill()
    process.wait()
    if process.stdout:
        process.stdout.close()


class LiveServer:
    def __init__(self, http_port=0, grpc_port=0, options=()):
        self.process = subprocess.Popen(
            [SERVER, "serve", "--http.address", f"127.0.0.1:{http_port}", "--grpc.address",
             f"127.0.0.1:{grpc_port}", *options], stdout=subprocess.PIPE, text=True)
        addresses = re.search(r"grpc=\S+:(\d+) http=(\S+:(\d+)/)", self.process.stdout.readline())
        self.grpc_port, self.url, self.port = addresses.groups()
        self.port = int(self.port)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(TIMEOUT_S)
        self.process.stdout.close()
        return code


class Publisher:
    def __init__(self, server, *flags):
        self.process = subprocess.Popen(
            [CLIENT, "--server", f"127.0.0.1:{server.grpc_port}", "publish", "--synthetic",
             "--stream", "scene", "--size", "320x240", "--fps", "5", "--quiet", *flags])

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(TIMEOUT_S)


def difference(a, b):
    """Root mean square over pixels and channels, of 255."""
    squares = ImageStat.Stat(ImageChops.difference(a, b)).rms
    return (sum(value * value for value in squares) / len(squares)) ** 0.5


class LivePage(PageTest):
    view_count = COLUMNS * ROWS

    def publish(self, *flags):
        publisher = Publisher(self.server, *flags)
        self.addCleanup(lambda: end(publisher.process))
        return publisher

    def setUp(self):
        self.server = LiveServer()
        self.addCleanup(lambda: end(self.server.process))
        self.publisher = self.publish()
        self.start_browser()
        self.wait_for_stream()

    def wait_for_stream(self):
        self.browser.open(self.server.url + "api/streams")
        self.browser.wait_for("fetch('/api/streams').then(r => r.json()).then("
                              "j => j.streams.some(({frame_number}) => frame_number > 0))")

    def shown_sequence(self):
        return int(self.browser.evaluate("document.documentElement.dataset.sequence"))

    def wait_for_view(self, view):
        """Until the page shows that view of the frame that stands; the tiles of a still of it."""
        deadline = time.monotonic() + TIMEOUT_S
        while time.monotonic() < deadline:
            reply = fetch(self.server.port, f"/still/scene_qs6x2a0.75.jpg?{DISPLAY}")
            self.assertEqual(reply.status, 200, reply.body[:300])
            tiles = self.tiles(reply.body)
            picture = self.shown_picture().resize(TILE, Image.Resampling.BOX)
            errors = [difference(picture, tile) for tile in tiles]
            if errors.index(min(errors)) == view:
                return tiles
        raise TimeoutError(f"the page never showed view {view} of the still: {errors}")

    def tiles(self, jpeg):
        image = Image.open(io.BytesIO(jpeg))
        width, height = TILE
        corners = [(view % COLUMNS * width, PADDING_TOP_PX + (ROWS - 1 - view // COLUMNS) * height)
                   for view in range(self.view_count)]
        return [image.crop((x, y, x + width, y + height)) for x, y in corners]

    def test_shows_the_scene_moving_and_then_the_view_under_the_pointer(self):
        self.open(f"?{DISPLAY}")
        self.look(0.5)
        before = self.shown_sequence()
        first = self.shown_picture()
        self.browser.wait_for(f"Number(document.documentElement.dataset.sequence) > {before} + 2")
        second = self.shown_picture()
        change = difference(first, second.resize(first.size))
        self.assertGreater(change, 1, "the scene stands still")
        keep(self.browser.screenshot(), "live")

        self.publisher.stop()  # the stream stands still from now on, and is shown all the same
        for share in (0.03, 0.4, 0.97):
            tiles = self.wait_for_view(self.look(share))
        self.assertGreater(difference(tiles[0], tiles[-1]), difference(tiles[0], tiles[1]))

    def test_the_example_looks_around_from_a_page_of_an_allowed_origin(self):
        pages = RayServer(folders=(EXAMPLES,))
        self.addCleanup(pages.close)
        self.publisher.stop()
        self.server.stop()
        self.server = LiveServer(options=("--http.allowed_origins", pages.url.rstrip("/")))
        self.publisher = self.publish("--seconds", "0.3", "--hold")
        self.wait_for_stream()
        self.browser.open(f"{pages.url}look_around.html?stream=scene"
                          f"&server=127.0.0.1:{self.server.port}")
        self.browser.wait_for("document.readyState === 'complete' && socket.readyState === 1")
        left, top, width, height = self.browser.evaluate(
            "(r => [r.x, r.y, r.width, r.height])(canvas.getBoundingClientRect())")
        shots = []
        for share in (0.3, 0.7):
            self.browser.evaluate("document.title = ''")
            self.browser.mouse(left + share * width, top + height / 2)
            self.browser.wait_for("document.title.startsWith('motion to picture: ')")
            shots.append(self.browser.screenshot().crop((left, top, left + width, top + height)))
        self.assertGreater(difference(*shots), 2, "another place shows another picture")
        self.assertEqual(self.browser.messages, [])

    def test_a_quilt_of_video_looks_as_one_of_jpeg(self):
        self.publisher.stop()
        shown = []
        for color in ("BAND_ENCODING_JPEG", "BAND_ENCODING_H264"):
            query = asked(QUILT, {"color": color, "jpeg_quality": 95}, "scene", mode="quilt",
                          detail="1")
            self.open(f"?{query}")
            self.browser.wait_for("document.getElementById('facts').textContent"
                                  f".includes('H.264') === {str('H264' in color).lower()}")
            shown.append(self.shown_picture())
        self.assertEqual(shown[0].size, shown[1].size)
        self.assertLess(difference(*shown), 6)

    def test_comes_back_after_a_restart_of_the_server(self):
        self.open(f"?{DISPLAY}")
        self.assertEqual(self.server.stop(), 0)
        self.browser.wait_for("document.documentElement.dataset.state === 'reconnecting'")
        self.server = LiveServer(self.server.port, self.server.grpc_port)
        self.browser.wait_for(LIVE)

    def test_the_command_for_elsewhere_receives_what_the_page_shows(self):
        for query, suffix, size in ((DISPLAY, "_qs6x2a0.75", (722, 323)),
                                    (asked(stream="scene", preset="portrait", detail=0.125),
                                     "_qs8x6a0.75", (3360, 3360))):
            with self.subTest(query), tempfile.TemporaryDirectory() as folder:
                self.open(f"?{query}")
                command = self.browser.wait_for("document.getElementById('command-watch').value")
                program = f"{os.path.abspath(CLIENT)} --server 127.0.0.1:{self.server.grpc_port}"
                self.assertEqual(command.count("viewloom watch "), 1)
                command = command.replace("viewloom watch ", program + " watch --count 1 ")
                ran = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True,
                                     text=True, timeout=TIMEOUT_S, check=False)
                self.assertEqual(ran.returncode, 0, ran.stderr)
                (name,) = [name for name in os.listdir(os.path.join(folder, "atlases"))
                           if name.endswith(suffix + ".jpg")]
                with Image.open(os.path.join(folder, "atlases", name)) as atlas:
                    self.assertEqual(atlas.size, size)

    def test_mirrors_show_what_they_mirror_by_a_checkbox(self):
        self.publisher.stop()
        self.publish("--mirrors", "--seconds", "0.1").process.wait(TIMEOUT_S)
        # The published frame no longer changes. Take it without reflections and with.
        tiles = [self.tiles(self.still(effects))
                 for effects in ({}, {"reflection": {"bounces": 2}})]
        self.open(f"?{DISPLAY}")
        view = self.look(0.5)
        without, mirrored = [of_views[view] for of_views in tiles]
        self.assertGreater(difference(without, mirrored), 2, "nothing mirrors")
        self.wait_for_picture(without, mirrored)
        for shown, other in ((mirrored, without), (without, mirrored)):
            self.browser.evaluate("document.getElementById('reflections').scrollIntoView()")
            self.browser.click("label.check:has(#reflections)")
            self.look(0.5)
            self.wait_for_picture(shown, other)

    def still(self, effects):
        """Reflections may take longer than a still waits."""
        deadline = time.monotonic() + TIMEOUT_S
        while time.monotonic() < deadline:
            display = asked({**QUILT, "effects": effects}, stream=None)
            reply = fetch(self.server.port, f"/still/scene_qs6x2a0.75.jpg?{display}")
            if reply.status != 504:
                self.assertEqual(reply.status, 200, reply.body[:300])
                return reply.body
        raise TimeoutError("no still came")

    def wait_for_picture(self, expected, other):
        """Until the page shows the one tile rather than the other: or fails."""
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            picture = self.shown_picture().resize(TILE, Image.Resampling.BOX)
            errors = [difference(picture, tile) for tile in (expected, other)]
            if errors[0] < errors[1]:
                return
            self.assertLess(time.monotonic(), deadline, f"differs by {errors}")

    def test_the_latency_of_a_frame_that_stands_is_not_its_age(self):
        first = WebSocket(self.server.port, f"/ws?{DISPLAY}")
        self.addCleanup(first.close)
        first.receive_atlas()
        self.publisher.stop()
        time.sleep(5)
        begin = time.monotonic()
        second = WebSocket(self.server.port, "/ws?" + asked(
            quilt(6, 2, 722, 323, aspect=0.75, focal_distance_m=2), stream="scene"))
        self.addCleanup(second.close)
        times = second.receive_atlas().header["times"]
        taken_s = time.monotonic() - begin
        # The frame was received, decoded and built before the request.
        later_ns = sum(times[f"{name}_ns"] for name in ("wait", "trace", "encode"))
        self.assertLess((times["wait_ns"] + times["trace_ns"]) / 1e9, taken_s)
        self.assertLess(times["total_ns"] - later_ns, 5e9)
        self.assertGreaterEqual(times["wait_ns"], 0)

    def test_depth_is_that_of_the_scene(self):
        viewer = WebSocket(self.server.port,
                           "/ws?" + asked(quilt(1, 1, 160, 120), {"with_depth": True}, "scene"))
        self.addCleanup(viewer.close)
        atlas = viewer.receive_atlas()
        inv_z = struct.unpack(f"<{160 * 120}f", atlas.depth)
        self.assertGreaterEqual(min(inv_z), 0)
        # The scene stands around the focal plane, which is its mean in 1/Z.
        focal = 1 / atlas.header["layout"]["focal_distance_m"]
        self.assertLess(min(inv_z), focal)
        self.assertGreater(max(inv_z), focal)
        self.assertLess(max(inv_z), 100)

    def test_a_hundred_viewers_of_one_display_cost_one_encode(self):
        viewers = [WebSocket(self.server.port, f"/ws?{DISPLAY}") for _ in range(100)]
        for viewer in viewers:
            self.addCleanup(viewer.close)
            viewer.shown(viewer.receive_atlas())
        for viewer in viewers:
            viewer.shown(viewer.receive_atlas())
        (display,) = fetch(self.server.port, "/api/displays").json()["displays"]
        self.assertEqual(display["subscriber_count"], 100)
        self.publisher.stop()
        deadline = time.monotonic() + TIMEOUT_S
        encoded, newest = 0, -1
        while encoded != newest and time.monotonic() < deadline:  # the last one is on its way
            still = fetch(self.server.port, f"/still/scene_qs6x2a0.75.jpg?{DISPLAY}")
            newest = int(still.headers["viewloom-sequence"])
            encoded = self.metric("viewloom_atlases_encoded_total")
        self.assertEqual(encoded, newest)
        self.assertGreater(newest, 1)
        self.assertGreaterEqual(self.metric('viewloom_atlases_sent_total{transport="web"}'), 200)

    def metric(self, name):
        text = fetch(self.server.port, "/metrics").body.decode()
        return float(next(line.split()[-1] for line in text.splitlines()
                          if line.startswith(name + " ")))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], "LivePage"])
