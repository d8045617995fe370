# SPDX-License-Identifier: Apache-2.0
"""The examples of the package do what they say, and the README's first picture is one of them."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.request

import viewloomd  # takes its argument

from PIL import Image

import scene
import viewloom

PACKAGE = pathlib.Path(__file__).parents[2] / "client" / "python"
FIRST_PICTURE_LINES_MAX = 10


class Examples(unittest.TestCase):
    def setUp(self):
        self.daemon = viewloomd.Viewloomd()
        self.addCleanup(self.daemon.stop)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_example(self, name, *options):
        done = subprocess.run(
            [sys.executable, PACKAGE / "examples" / name, *options], cwd=self.folder,
            capture_output=True, text=True, timeout=viewloomd.PATIENCE_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_first_picture_is_a_quilt_of_a_ball(self):
        self.run_example("first_picture.py", self.daemon.address)
        quilt = Image.open(self.folder / "ball.jpg")
        self.assertEqual(quilt.size, (3360, 3360))
        # The middle of view 0, at the bottom left, and of the last one: the ball, red.
        for x, y in ((210, 3360 - 280), (3360 - 210, 280)):
            red, green, blue = quilt.getpixel((x, y))
            self.assertGreater(red, green + blue)

    def test_the_first_picture_takes_less_than_ten_lines_and_is_the_readmes(self):
        code = (PACKAGE / "examples" / "first_picture.py").read_text(encoding="utf-8")
        code = code.split("import viewloom\n")[1].strip()
        lines = [line for line in code.splitlines() if line]
        self.assertLess(len(lines), FIRST_PICTURE_LINES_MAX)
        shown = re.findall(r"```python\n(.*?)```", (PACKAGE / "README.md").read_text(
            encoding="utf-8"), re.DOTALL)
        self.assertIn(code.replace("*sys.argv[1:]", ""), "\n".join(shown))

    def test_a_head_is_replayed_pose_by_pose(self):
        """A head at rest sees the same twice; one that moves, or turns, sees something else."""
        turned = {"pose": {"position": {"x": 0.05}, "orientation": {"y": 0.1, "w": 0.99499}},
                  "fov": {"angleLeftRad": -0.5, "angleRightRad": 0.5, "angleDownRad": -0.4,
                          "angleUpRad": 0.4}}
        places = [([-0.03, 0, 0], [0.03, 0, 0]), ([-0.03, 0, 0], [0.03, 0, 0]),
                  ([-0.2, 0.1, 0.1], [-0.14, 0.1, 0.1]), (turned, turned)]
        track = self.folder / "head.jsonl"
        track.write_text("\n".join(json.dumps({"time_ns": 9, "left": left, "right": right})
                                   for left, right in places) + "\n", encoding="utf-8")
        with viewloom.connect(self.daemon.address) as server, \
                server.publish("demo") as publisher:
            publisher.send(scene.source(scene.noise_color(), scene.step_depth()))
            said = self.run_example("replay_head.py", str(track), "--server", self.daemon.address,
                                    "--width", "64", "--height", "48", "--focal-distance", "2")
        self.assertEqual(re.findall(r"^pose (\d+): frame 1, ", said, re.MULTILINE),
                         ["0", "1", "2", "3"])
        seen = [(self.folder / "seen" / f"{number:05d}.jpg").read_bytes() for number in range(4)]
        self.assertEqual(Image.open(self.folder / "seen" / "00000.jpg").size, (128, 48))
        self.assertEqual(seen[0], seen[1])
        self.assertEqual(len(set(seen)), 3)
        with urllib.request.urlopen(self.daemon.url + "metrics") as metrics:
            counted = re.search(r"viewloom_motion_to_image_seconds_count (\d+)",
                                metrics.read().decode())
        self.assertGreaterEqual(int(counted[1]), 3)  # the last word may be lost with the call

    def test_views_are_watched_with_asyncio(self):
        with viewloom.connect(self.daemon.address) as server, \
                server.publish("demo") as publisher:
            publisher.send(scene.source(scene.noise_color(), scene.step_depth()))
            said = self.run_example("watch_asyncio.py", "--server", self.daemon.address,
                                    "--count", "1")
        self.assertEqual(said, f"frame 1: the nearest px of view 24 is {scene.NEAR_M:.2f} m away, "
                         "0 atlases were skipped\n")


if __name__ == "__main__":
    unittest.main()
