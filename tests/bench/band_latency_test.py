# SPDX-License-Identifier: Apache-2.0
"""That band_latency.py measures what it says: bands come in order, and before the atlas ends.
Arguments: band_latency.py, the build folder."""
import json
import subprocess
import sys
import unittest

BUILD = sys.argv.pop()
PROGRAM = sys.argv.pop()


class BandLatency(unittest.TestCase):
    def figures_of(self, kind):
        run = subprocess.run(
            [sys.executable, PROGRAM, BUILD, "--rounds", "1", "--frames", "3", "--warm-up", "1",
             "--size", "320x180", "--only", kind, "--json"], capture_output=True,
            text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        (figures,) = json.loads(run.stdout)
        return [figures[f"{mark} ms"] for mark in ("first band", "last band", "end")]

    def test_measures_one_kind(self):
        marks = self.figures_of("swept quilt")
        self.assertEqual(marks, sorted(marks))

    # Pictures leave while others are swept.
    def test_measures_video(self):
        marks = self.figures_of("swept quilt as video")
        self.assertEqual(marks, sorted(marks))
        self.assertLess(marks[0], marks[1])


if __name__ == "__main__":
    unittest.main()
