# SPDX-License-Identifier: Apache-2.0
"""What the READMEs of Python and Node say to type works on what the demo has built."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import viewloomd  # takes its argument

import numpy as np

import scene
import viewloom

BUILD = pathlib.Path(sys.argv.pop(1))
ROOT = pathlib.Path(__file__).parents[2]
README = "".join((ROOT / "client" / folder / "README.md").read_text(encoding="utf-8")
                 for folder in ("python", "node"))
PACKAGE_FOLDER = "build/release/client/python"


def block(holds, language=""):
    """The block of the READMEs with these words."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
    return next(text for of, text in blocks if of == language and holds in text)


class ReadmeLines(unittest.TestCase):
    def setUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.addCleanup(self.daemon.stop)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.clone = pathlib.Path(folder.name)  # as a clone is, once the demo has run
        (self.clone / "build").mkdir()
        (self.clone / "build" / "release").symlink_to(BUILD)
        for name in ("client", "proto"):
            (self.clone / name).symlink_to(ROOT / name)

    def test_the_demo_builds_what_the_python_lines_use(self):
        demo = (ROOT / "deploy" / "demo.sh").read_text(encoding="utf-8").replace("\\\n", " ")
        targets = set(re.search(r"cmake --build .*--target (.*)", demo)[1].split())
        self.assertLessEqual({"viewloomd", "viewloom", "viewloom_python"}, targets)
        self.assertIn(f"export PYTHONPATH={PACKAGE_FOLDER}", block("first_picture.py"))
        self.assertTrue((self.clone / PACKAGE_FOLDER / "viewloom" / "__init__.py").is_file())

    def test_the_python_lines_make_the_picture(self):
        lines = block("first_picture.py").replace("\\\n", " ").splitlines()
        lines = [line for line in lines if not line.startswith("sudo apt-get")]
        self.assertEqual(len(lines), 2)
        lines[-1] += " " + self.daemon.address  # the demo has the default one
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        done = subprocess.run("\n".join(["set -e", *lines]), shell=True, cwd=self.clone,
                              env=environment, capture_output=True, text=True, check=False,
                              timeout=viewloomd.PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.clone / "ball.jpg").is_file())

    def test_the_python_block_says_what_it_gives(self):
        code = block("quilt.view(24)", "python")
        names = {"viewloom": viewloom, "color": scene.smooth_color(),
                 "depth_m": scene.step_depth()}
        exec(code.replace("connect()", f"connect({self.daemon.address!r})"), names)
        self.assertEqual((names["middle"].shape, names["middle"].dtype), ((560, 420, 3), np.uint8))

    def test_the_node_lines_name_files_and_options_that_exist(self):
        lines = block("watch_quilt.js")
        folder = self.clone / re.search(r"cd (\S+) &&", lines)[1]
        self.assertIn("npm ci", lines)
        self.assertTrue((folder / "package-lock.json").is_file())
        script, words = re.search(r"^node (\S+) (.*)", lines, re.MULTILINE).groups()
        code = "".join((folder / name).read_text(encoding="utf-8")
                       for name in (script, "command_line.js"))
        for option in re.findall(r"--(\w+)", words):
            self.assertRegex(code, rf"\b{option}: {{type: 'string'")


if __name__ == "__main__":
    unittest.main()
