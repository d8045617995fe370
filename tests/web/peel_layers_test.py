# SPDX-License-Identifier: Apache-2.0
"""The example of depth peeling, run in a browser: its layers against the planes that it draws, and
as viewloom reads them."""
import functools
import http.server
import json
import os
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

from PIL import Image

from browser import CHROMIUM, Browser

WIDTH, HEIGHT, FOCAL = 192, 128, 160
SQUARE_HALF_SIDE_PX = 0.4 / 2 * FOCAL
ROUNDING = 5e-5  # 1/m: a sixteenth of a px along the wall


def wall_inv_z(x):
    """Z = 4 + X / 2 with X = Z (x + 0.5 - WIDTH / 2) / FOCAL, solved for 1/Z."""
    return (1 - 0.5 * (x + 0.5 - WIDTH / 2) / FOCAL) / 4


def in_square(x, y):
    return (abs(x + 0.5 - WIDTH / 2) < SQUARE_HALF_SIDE_PX
            and abs(y + 0.5 - HEIGHT / 2) < SQUARE_HALF_SIDE_PX)


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, format, *args):  # pylint: disable=redefined-builtin
        pass


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class PeelLayers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        handler = functools.partial(QuietHandler, directory=EXAMPLES)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        cls.addClassCleanup(server.server_close)
        cls.addClassCleanup(server.shutdown)
        with Browser() as browser:
            browser.open(f"http://127.0.0.1:{server.server_address[1]}/peel_layers.html")
            browser.wait_for("window.layers !== undefined")
            cls.layers = browser.evaluate(
                "layers.map(l => ({color: [...l.color], invZ: [...l.invZ]}))")

    def inv_z(self, layer, x, y):
        return self.layers[layer]["invZ"][y * WIDTH + x]

    def test_layer_0_is_the_nearest_surface(self):
        for y in range(HEIGHT):
            for x in range(WIDTH):
                wanted = 0.5 if in_square(x, y) else wall_inv_z(x)
                self.assertAlmostEqual(self.inv_z(0, x, y), wanted, delta=ROUNDING, msg=f"{x}, {y}")

    def test_layer_1_is_the_wall_behind_the_square_and_nothing_elsewhere(self):
        for y in range(HEIGHT):
            for x in range(WIDTH):
                # Neither the coat of paint 1 % behind the square nor the face turned away.
                wanted = wall_inv_z(x) if in_square(x, y) else 0
                self.assertAlmostEqual(self.inv_z(1, x, y), wanted, delta=ROUNDING, msg=f"{x}, {y}")

    def test_each_layer_has_the_colour_of_its_surface(self):
        middle = 4 * (HEIGHT // 2 * WIDTH + WIDTH // 2)
        self.assertEqual(self.layers[0]["color"][middle:middle + 4], [230, 128, 26, 255])
        self.assertEqual(self.layers[1]["color"][middle:middle + 4], [51, 102, 204, 255])
        self.assertEqual(self.layers[1]["color"][:4], [0, 0, 0, 0])

    def test_viewloom_reads_the_layers(self):
        with tempfile.TemporaryDirectory() as folder:
            layers = []
            for index, layer in enumerate(self.layers):
                color, depth = f"color_{index}.png", f"depth_{index}.pfm"
                Image.frombytes("RGBA", (WIDTH, HEIGHT), bytes(layer["color"])).save(
                    os.path.join(folder, color))
                with open(os.path.join(folder, depth), "wb") as file:  # the bottom row first
                    file.write(f"Pf\n{WIDTH} {HEIGHT}\n-1\n".encode())
                    for y in reversed(range(HEIGHT)):
                        file.write(struct.pack(f"<{WIDTH}f",
                                               *layer["invZ"][y * WIDTH:(y + 1) * WIDTH]))
                layers.append({"color": {"file": color, "alpha": "ALPHA_MODE_OPAQUE"},
                               "depth": {"file": depth, "depth": {
                                   "meaning": "DEPTH_MEANING_DISPARITY", "scale": 1,
                                   # Nothing, not a sky: -1 would do as well.
                                   "invalidValue": 0}}})
            camera = {"intrinsics": {"focalXPx": FOCAL, "focalYPx": FOCAL,
                                     "principalXPx": WIDTH / 2, "principalYPx": HEIGHT / 2}}
            frame = os.path.join(folder, "frame.json")
            with open(frame, "w", encoding="utf-8") as file:
                json.dump({"sources": [{"camera": camera, "layers": layers}]}, file)
            report = json.loads(subprocess.run([VIEWLOOM, "inspect", "--json", frame], check=True,
                                               stdout=subprocess.PIPE).stdout)
        read = [layer["depth"] for layer in report[0]["sources"][0]["layers"]]
        self.assertAlmostEqual(read[0]["min_m"], 2, places=4)
        self.assertEqual(read[0]["surface_count"], WIDTH * HEIGHT)
        in_front = sum(in_square(x, y) for y in range(HEIGHT) for x in range(WIDTH))
        self.assertEqual(read[1]["surface_count"], in_front)
        self.assertAlmostEqual(read[1]["median_m"], 4, delta=0.02)


if __name__ == "__main__":
    VIEWLOOM, EXAMPLES = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
