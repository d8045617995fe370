# SPDX-License-Identifier: Apache-2.0
"""What a quilt's JPEG says about itself, as Pillow and ExifTool read it: a still over HTTP, and a
file of `viewloom watch`. Arguments: viewloomd, viewloom."""
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import urllib.request

import viewloomd  # takes its argument

from PIL import Image

CLIENT = sys.argv.pop(1)
EXIF_IFD, EXIF_VERSION, USER_COMMENT = 0x8769, 0x9000, 0x9286
QUILT = {"LKGNumViews": 6, "LKGRows": 2, "LKGColumns": 3, "LKGAspect": 0.75, "LKGType": "quilt"}


class QuiltMetadata(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = viewloomd.Viewloomd()
        cls.addClassCleanup(cls.server.stop)
        subprocess.run([CLIENT, "--server", cls.server.address, "publish", "--synthetic",
                        "--stream", "scene", "--size", "160x120", "--seconds", "0.1", "--quiet"],
                       check=True, timeout=viewloomd.PATIENCE_S)
        cls.address = "still/scene_qs3x2a0.75.{}?width=240&height=240"

    def get(self, extension):
        with urllib.request.urlopen(self.server.url + self.address.format(extension),
                                    timeout=viewloomd.PATIENCE_S) as reply:
            return reply.read()

    def check(self, jpeg):
        self.assertEqual(jpeg[2:4], b"\xff\xe1", "APP1 is not the first segment")
        image = Image.open(io.BytesIO(jpeg))
        image.load()
        self.assertIn("jfif", image.info)
        exif = image.getexif()
        self.assertEqual(list(exif), [EXIF_IFD])
        tags = exif.get_ifd(EXIF_IFD)
        self.assertEqual(tags[EXIF_VERSION], b"0232")
        code, text = tags[USER_COMMENT][:8], tags[USER_COMMENT][8:]
        self.assertEqual(code, b"ASCII\0\0\0")
        self.assertEqual(json.loads(text), QUILT)
        told = subprocess.run(["exiftool", "-json", "-warning", "-error", "-UserComment", "-"],
                              input=jpeg, capture_output=True, check=True,
                              timeout=viewloomd.PATIENCE_S)
        (told,) = json.loads(told.stdout)
        self.assertEqual(json.loads(told.pop("UserComment")), QUILT)
        self.assertEqual(list(told), ["SourceFile"], "ExifTool has something to say")

    def test_of_a_still(self):
        self.check(self.get("jpg"))

    def test_of_a_file_that_watch_writes(self):
        display = {"quilt": {"columns": 3, "rows": 2, "size": {"width": 240, "height": 240},
                             "aspect": 0.75, "viewConeRad": 0.6}}
        with tempfile.TemporaryDirectory() as folder:
            spec = pathlib.Path(folder) / "display.json"
            spec.write_text(json.dumps(display), encoding="ascii")
            subprocess.run([CLIENT, "--server", self.server.address, "watch", "scene", "--display",
                            spec, "--count", "1", "--out", folder, "--quiet"], check=True,
                           timeout=viewloomd.PATIENCE_S)
            (file,) = pathlib.Path(folder).glob("*_qs3x2a0.75.jpg")
            self.check(file.read_bytes())

    def test_of_the_layout_beside_a_still(self):
        layout = json.loads(self.get("json"))
        self.assertEqual([layout["view_count"], layout["rows"], layout["columns"],
                          layout["aspect"]], [6, 2, 3, 0.75])
        self.assertEqual(layout["order"], "BOTTOM_LEFT")


if __name__ == "__main__":
    unittest.main()
