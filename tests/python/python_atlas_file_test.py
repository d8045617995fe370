# SPDX-License-Identifier: Apache-2.0
"""What Atlas.save leaves on the disk, and what it never touches."""

import io
import os
import pathlib
import re
import resource
import tempfile
import unittest

import numpy as np
from PIL import Image

import viewloom
from viewloom.atlas import Band
from viewloom.v1 import atlas_pb2
from viewloom.v1.atlas_pb2 import AtlasLayout
from viewloom.v1.display_service_pb2 import AtlasHeader

LAYOUT = {"size": {"width": 8, "height": 6}, "tile_size": {"width": 4, "height": 6}, "columns": 2,
          "rows": 1, "view_count": 2, "suffix": "_qs2x1a0.75"}
PICTURE = np.arange(8 * 6 * 3, dtype=np.uint8).reshape(6, 8, 3)


def jpeg_bytes():
    file = io.BytesIO()
    Image.fromarray(PICTURE).save(file, "JPEG")
    return file.getvalue()


def atlas(encoding=atlas_pb2.BAND_ENCODING_JPEG, data=None, stream="demo", **layout):
    band = Band(0, atlas_pb2.ATLAS_PLANE_COLOR, 0, 6, encoding,
                bytearray(jpeg_bytes() if data is None else data))
    return viewloom.Atlas(AtlasLayout(**{**LAYOUT, **layout}), AtlasHeader(frame_number=12),
                          [band], stream=stream)


def raw_atlas(**more):
    return atlas(atlas_pb2.BAND_ENCODING_RAW, PICTURE.tobytes(), **more)


class Saving(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def names(self):
        return sorted(entry.name for entry in self.folder.iterdir())

    def test_a_jpeg_is_what_came_byte_for_byte(self):
        file = self.folder / "quilt.JPG"
        self.assertEqual(atlas().save(file), file)
        self.assertEqual(file.read_bytes(), jpeg_bytes())

    def test_a_full_disk_leaves_what_was_there(self):
        """Files that may hold a hundred bytes stand for a disk that is full."""
        file = self.folder / "quilt.jpg"
        file.write_bytes(b"before")
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, limits)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
        with self.assertRaises(OSError) as raised:
            atlas().save(file)
        self.assertIn(f"cannot be written: it reached the largest size allowed: '{file}'",
                      str(raised.exception))
        self.assertEqual(self.names(), ["quilt.jpg"])
        self.assertEqual(file.read_bytes(), b"before")

    def test_a_png_has_every_pixel(self):
        for shown in (atlas(), raw_atlas()):
            np.testing.assert_array_equal(
                np.asarray(Image.open(shown.save(self.folder / "quilt.png"))), shown.color)

    def test_a_folder_gets_a_name_with_the_layout(self):
        self.assertEqual(atlas().save(self.folder).name, "demo_000012_qs2x1a0.75.jpg")
        self.assertEqual(raw_atlas(suffix="").save(f"{self.folder}/new/").name, "demo_000012.png")
        self.assertEqual(self.names(), ["demo_000012_qs2x1a0.75.jpg", "new"])

    def test_what_a_server_says_does_not_leave_the_folder(self):
        for named in ({"suffix": "/../../x"}, {"suffix": "_qs2x1a1/../y"}, {"stream": "../z"},
                      {"stream": "a/b"}, {"stream": ".."}, {"stream": ""}):
            self.assertEqual(atlas(**named).save(self.folder).parent, self.folder.resolve())

    def test_a_file_is_replaced_whole_and_nothing_is_left_beside_it(self):
        file = self.folder / "quilt.jpg"
        file.write_bytes(b"old")
        os.link(file, self.folder / "other name")
        atlas().save(file)
        self.assertEqual((self.folder / "other name").read_bytes(), b"old")
        self.assertEqual(self.names(), ["other name", "quilt.jpg"])
        self.assertEqual(file.stat().st_mode & 0o111, 0)
        self.assertEqual(file.stat().st_mode & 0o600, 0o600)

    def test_an_atlas_that_cannot_be_written_leaves_the_old_file(self):
        file = self.folder / "quilt.png"
        file.write_bytes(b"old")
        with self.assertRaises(viewloom.ViewloomError):
            atlas(data=b"no picture").save(file)
        self.assertEqual((file.read_bytes(), self.names()), (b"old", ["quilt.png"]))

    def test_a_link_stays_and_what_it_names_is_replaced(self):
        link, file = self.folder / "newest.jpg", self.folder / "quilt.jpg"
        link.symlink_to(file)
        atlas().save(link)
        self.assertTrue(link.is_symlink())
        self.assertEqual(file.read_bytes(), jpeg_bytes())

    def test_what_is_no_regular_file_is_never_replaced(self):
        os.mkfifo(self.folder / "pipe.jpg")
        (self.folder / "null.jpg").symlink_to("/dev/null")
        for name in ("pipe.jpg", "null.jpg"):
            with self.assertRaisesRegex(viewloom.BadInput, "no regular file"):
                atlas().save(self.folder / name)
        self.assertTrue((self.folder / "pipe.jpg").is_fifo())

    def test_names_that_cannot_be_are_refused(self):
        for name, words in (("quilt.gif", "must end in .jpg"), ("quilt", "must end in .jpg"),
                            ("none/quilt.jpg", "folder that does not exist"), ("", "is ''")):
            with self.assertRaisesRegex(viewloom.BadInput, words):
                atlas().save(self.folder / name if name else name)
        with self.assertRaisesRegex(viewloom.BadInput, "save it as .png"):
            raw_atlas().save(self.folder / "quilt.jpg")
        with self.assertRaisesRegex(viewloom.BadInput, "save it as .png"):
            atlas(image_count=2).save(self.folder / "quilt.jpg")


class Printed(unittest.TestCase):
    def test_an_atlas_is_one_line(self):
        self.assertEqual(repr(raw_atlas()), "<viewloom.Atlas of 'demo', frame 12: 2 views of 4x6 "
                         "px in 8x6, 144 bytes of RAW>")
        self.assertNotIn("bytearray", repr(raw_atlas().bands))

    def test_the_version_is_the_projects(self):
        lists = pathlib.Path(__file__).parents[2] / "CMakeLists.txt"
        version = re.search(r"project\(viewloom VERSION (\S+)", lists.read_text(encoding="utf-8"))
        self.assertEqual(viewloom.__version__, version[1])


if __name__ == "__main__":
    unittest.main()
