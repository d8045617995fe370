# SPDX-License-Identifier: Apache-2.0
"""Stills over HTTP: their pictures, their layouts, and the names they are saved under."""
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

from PIL import Image

from painted_case import PaintedCase
from web_client import decode_view, fetch

PROGRAM = sys.argv.pop(1)
SMALL = "width=320&height=160"


class Stills(PaintedCase):
    PROGRAM = PROGRAM

    def test_serves_a_still_whose_url_says_how_its_views_lie(self):
        reply = fetch(self.port, f"/still/painted_qs4x2a1.jpg?{SMALL}")
        if reply.status == 302:  # the suffix as the server writes it
            reply = fetch(self.port, reply.location)
        self.assertEqual(reply.status, 200, reply.body)
        self.assertEqual(reply.headers["content-type"], "image/jpeg")
        image = Image.open(io.BytesIO(reply.body))
        self.assertEqual(image.size, (320, 160))
        layout = {"columns": 4, "rows": 2, "padding_top_px": 0,
                  "tile_size": {"width": 80, "height": 80}}
        self.assertEqual([decode_view(image, layout, view) for view in range(8)], list(range(8)))

    def test_tells_the_layout_of_a_still_beside_it(self):
        layout = fetch(self.port, f"/still/painted_qs4x2a1.json?{SMALL}").json()
        self.assertEqual([layout["columns"], layout["rows"], layout["view_count"]], [4, 2, 8])
        self.assertEqual((layout["size"], layout["suffix"]),
                         ({"width": 320, "height": 160}, "_qs4x2a1"))

    def test_redirects_a_short_still_to_the_one_with_the_suffix(self):
        reply = fetch(self.port, "/still/painted/portrait")
        self.assertEqual(reply.status, 302)
        self.assertEqual(reply.location,
                         "/still/painted_qs8x6a0.75.jpg?preset=portrait")
        self.assertTrue(reply.headers["location"].startswith("../"), "a proxy may add a path")
        wrong = fetch(self.port, "/still/painted_qs5x9a1.6.jpg?preset=portrait")
        self.assertEqual(wrong.location, reply.location)

    def test_a_display_that_is_no_quilt_is_found_by_its_name(self):
        size = "width=64&height=36"
        still = fetch(self.port, f"/still/painted/wowvx?{size}")
        self.assertEqual(still.status, 200, still.body)
        self.assertEqual(still.headers["content-disposition"],
                         'inline; filename="painted_wowvx.jpg"')
        layout = fetch(self.port, f"/still/painted/wowvx.json?{size}").json()
        self.assertEqual(layout["size"], {"width": 128, "height": 36})
        suffix = fetch(self.port, f"/still/painted_qs8x6a0.75.jpg?preset=wowvx&{size}")
        self.assertEqual((suffix.status, suffix.location),
                         (302, "/still/painted/wowvx.jpg?height=36&width=64"))

    def test_names_the_file_that_a_still_is_to_be_saved_as(self):
        size = "width=320&height=480"
        for target, name in ((f"/still/painted/portrait?{size}", "painted_qs8x6a0.75.jpg"),
                             (f"/still/painted/portrait.jpg?{size}", "painted_qs8x6a0.75.jpg"),
                             (f"/still/painted/portrait.json?{size}", "painted_qs8x6a0.75.json"),
                             (f"/still/painted_qs4x2a1.jpg?{SMALL}", "painted_qs4x2a1.jpg"),
                             (f"/still/painted_qs4x2a1.json?{SMALL}", "painted_qs4x2a1.json")):
            with self.subTest(target):
                reply = fetch(self.port, target)
                if reply.status == 302:
                    reply = fetch(self.port, reply.location)
                self.assertEqual(reply.status, 200, reply.body)
                self.assertEqual(reply.headers["content-disposition"],
                                 f'inline; filename="{name}"')

    @unittest.skipUnless(shutil.which("curl"), "there is no curl")
    def test_curl_saves_a_still_under_its_name_and_its_layout_beside_it(self):
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("", ".json"):
                subprocess.run(
                    ["curl", "-L", "-O", "-J", f"http://127.0.0.1:{self.port}/still/painted/"
                     f"portrait{ending}?width=320&height=480"],
                    cwd=folder, check=True, capture_output=True)
            self.assertEqual(sorted(os.listdir(folder)),
                             ["painted_qs8x6a0.75.jpg", "painted_qs8x6a0.75.json"])
            with Image.open(os.path.join(folder, "painted_qs8x6a0.75.jpg")) as still:
                self.assertEqual(still.size, (320, 480))
            with open(os.path.join(folder, "painted_qs8x6a0.75.json"), encoding="ascii") as layout:
                self.assertEqual(json.load(layout)["view_count"], 48)

    def test_gives_up_on_a_still_that_does_not_come(self):
        location = fetch(self.port, "/still/silent/portrait").location
        reply = fetch(self.port, location)
        self.assertEqual(reply.status, 504)
        self.assertIn("was ready within 3000 ms", reply.json()["error"]["message"])


if __name__ == "__main__":
    unittest.main()
