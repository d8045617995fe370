#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""standing_scene.py measures what it says: pictures while the scene moves, and a sharp one while it
stands."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [sys.argv.pop(1), sys.argv.pop(1)]
CHROMIUM = "/usr/bin/chromium"


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class StandingSceneTest(unittest.TestCase):
    def test_a_rest_is_seen(self):
        script = pathlib.Path(__file__).with_name("standing_scene.py")
        finished = subprocess.run(
            ["/usr/bin/python3", script, *PROGRAMS, "--json", "--frames", "300x400", "--rests",
             "1"], capture_output=True, text=True, check=False)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        (rest,) = json.loads(finished.stdout)
        self.assertGreater(rest["pictures/s"], 0)
        self.assertGreater(rest["sharp width px"], 200)
        self.assertGreaterEqual(rest["sharp after s"], 0)
        self.assertLess(rest["sharp after s"], 5, "the scene stands no longer")


if __name__ == "__main__":
    unittest.main()
