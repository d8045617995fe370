# SPDX-License-Identifier: Apache-2.0
"""The comparison finds a build equal to itself, and tells pictures apart that are not the same.
Argument: the build folder."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1))

import compare_builds
import displays
import scenes
from served_build import ServedBuild


class CompareBuilds(unittest.TestCase):
    def test_finds_a_build_equal_to_itself(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            status = compare_builds.main([str(BUILD), str(BUILD), "--quick"])
        self.assertEqual(status, 0, said.getvalue())
        count = len(compare_builds.SHORT_FORM)
        self.assertIn(f"{count} compared: 0 differ; 0 were refused before", said.getvalue())

    def test_tells_pictures_apart(self):
        with tempfile.TemporaryDirectory() as scratch:
            files = pathlib.Path(scratch)
            scenes.write_files(files)
            build = ServedBuild(BUILD)
            try:
                build.publish("scene", scenes.published(files)["one-layer"])
                first, second = (build.ask("scene", displays.DISPLAYS[name], displays.LOSSLESS)
                                 for name in ("quilt", "quilt-core"))
                packed = build.ask("scene", displays.DISPLAYS["quilt"], displays.ENCODINGS["jpeg"])
                refused = build.ask("scene", {"preset": "nothing"}, displays.LOSSLESS)
            finally:
                build.stop()
        self.assertEqual(list(compare_builds.differences(first, first)), [])
        found = "\n".join(compare_builds.differences(first, second))
        self.assertRegex(found, r"image 0, ATLAS_PLANE_COLOR differs by up to \d+ in [1-9]\S*% of")
        self.assertRegex(found, r"image 0, ATLAS_PLANE_DEPTH differs by up to [0-9.e-]+ in ")
        self.assertRegex(found, r"views: ")
        self.assertIn("is in one of the builds only",
                      "\n".join(compare_builds.differences(first, packed)))
        self.assertRegex("\n".join(compare_builds.differences(first, refused)),
                         r"refused: None before, NOT_FOUND: .*nothing")


if __name__ == "__main__":
    unittest.main()
