# SPDX-License-Identifier: Apache-2.0
"""The whole path: viewloom publishes its moving scene, viewloomd serves it, a browser shows it.
Arguments: viewloomd, viewloom. Screenshots go to the folder VIEWLOOM_SCREENSHOTS, when it is set."""
import io
import re
import signal
import subprocess
import sys
import unittest

from PIL import Image, ImageChops, ImageStat

from page_test import LIVE, PageTest, keep
from web_client import TIMEOUT_S, fetch

SERVER, CLIENT = sys.argv.pop(1), sys.argv.pop(1)
DISPLAY = "columns=8&rows=6&width=1680&height=2240&aspect=0.75"
COLUMNS, ROWS, TILE = 8, 6, (210, 373)  # of DISPLAY; 2 px at the top are padding
PADDING_TOP_PX = 2


class LiveServer:
    def __init__(self, http_port=0, grpc_port=0):
        self.process = subprocess.Popen(
            [SERVER, "serve", "--http.address", f"127.0.0.1:{http_port}", "--grpc.address",
             f"127.0.0.1:{grpc_port}"], stdout=subprocess.PIPE, text=True)
        addresses = re.search(r"grpc=\S+:(\d+) http=(\S+:(\d+)/)", self.process.stdout.readline())
        self.grpc_port, self.url, self.port = addresses.groups()
        self.port = int(self.port)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(TIMEOUT_S)
        self.process.stdout.close()
        return code


class Publisher:
    def __init__(self, server, *options):
        self.process = subprocess.Popen(
            [CLIENT, "--server", f"127.0.0.1:{server.grpc_port}", "publish", "--synthetic",
             "--stream", "scene", "--size", "640x480", "--fps", "5", "--quiet", *options])

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(TIMEOUT_S)


def difference(a, b):
    """Root mean square over pixels and channels, of 255."""
    squares = ImageStat.Stat(ImageChops.difference(a, b)).rms
    return (sum(value * value for value in squares) / len(squares)) ** 0.5


class LivePage(PageTest):
    def setUp(self):
        self.server = LiveServer()
        self.addCleanup(lambda: self.server.process.kill())
        self.publisher = Publisher(self.server)
        self.addCleanup(lambda: self.publisher.process.kill())
        self.start_browser()

    def still_views(self):
        reply = fetch(self.server.port, f"/still/scene_qs8x6a0.75.jpg?{DISPLAY}")
        self.assertEqual(reply.status, 200, reply.headers)
        image = Image.open(io.BytesIO(reply.body))
        width, height = TILE
        corners = [(view % COLUMNS * width, PADDING_TOP_PX + (ROWS - 1 - view // COLUMNS) * height)
                   for view in range(COLUMNS * ROWS)]
        return [image.crop((x, y, x + width, y + height)) for x, y in corners]

    def test_shows_the_scene_moving_and_then_the_view_under_the_pointer(self):
        self.open(f"?stream=scene&{DISPLAY}")
        self.look(0.5)
        before = self.shown_sequence()
        first = self.shown_picture()
        self.browser.wait_for(f"Number(document.documentElement.dataset.sequence) > {before} + 5")
        second = self.shown_picture()
        self.assertEqual(first.size, second.size)
        self.assertGreater(difference(first, second), 1, "the scene does not move")
        keep(self.browser.screenshot(), "live")

        # Without its publisher the stream stands still, and a still is what the page shows.
        self.publisher.stop()
        views = self.still_views()
        for share in (0.03, 0.4, 0.97):
            shown_view = self.look(share)
            picture = self.shown_picture().resize(TILE, Image.Resampling.BOX)
            errors = [difference(picture, view) for view in views]
            self.assertEqual(errors.index(min(errors)), shown_view, errors)
        self.assertGreater(difference(views[0], views[-1]), 2 * min(errors), "no parallax")

    def test_comes_back_after_a_restart_of_the_server(self):
        self.open(f"?stream=scene&{DISPLAY}")
        self.assertEqual(self.server.stop(), 0)
        self.browser.wait_for("document.documentElement.dataset.state === 'reconnecting'")
        self.server = LiveServer(self.server.port, self.server.grpc_port)
        self.browser.wait_for(LIVE)

    def shown_sequence(self):
        return int(self.browser.evaluate("document.documentElement.dataset.sequence"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:], "LivePage"])
