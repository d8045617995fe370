# SPDX-License-Identifier: Apache-2.0
"""That first_use.py measures what it says: every figure is there, and a first picture comes.
Arguments: first_use.py, the build folder."""
import json
import subprocess
import sys
import unittest

BUILD = sys.argv.pop()
PROGRAM = sys.argv.pop()


class FirstUse(unittest.TestCase):
    def test_measures_one_kind(self):
        run = subprocess.run(
            [sys.executable, PROGRAM, BUILD, "--rounds", "1", "--only", "tracked stereo",
             "--warm-up", "1", "--json"], capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        (figures,) = json.loads(run.stdout)
        self.assertEqual(figures["kind"], "tracked stereo")
        for name in ("first picture s", "later picture s", "gap before s", "gap meanwhile s"):
            self.assertGreater(figures[name], 0, name)


if __name__ == "__main__":
    unittest.main()
