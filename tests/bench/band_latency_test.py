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
    def test_measures_one_kind(self):
        run = subprocess.run(
            [sys.executable, PROGRAM, BUILD, "--rounds", "1", "--frames", "3", "--warm-up", "1",
             "--size", "320x180", "--only", "swept quilt", "--json"], capture_output=True,
            text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        (figures,) = json.loads(run.stdout)
        marks = [figures[f"{mark} ms"] for mark in ("first band", "last band", "end")]
        self.assertEqual(marks, sorted(marks))


if __name__ == "__main__":
    unittest.main()
