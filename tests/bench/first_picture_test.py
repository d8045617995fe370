#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""first_picture.py measures what it says: on the page a sharp picture, and others while the pointer
moves, before a stream that moves and before one that stands."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [sys.argv.pop(1), sys.argv.pop(1)]
CHROMIUM = "/usr/bin/chromium"


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class FirstPictureTest(unittest.TestCase):
    def test_sharp_pictures_are_drawn(self):
        script = pathlib.Path(__file__).with_name("first_picture.py")
        finished = subprocess.run(
            ["/usr/bin/python3", script, *PROGRAMS, "--json", "--rounds", "1", "--seconds", "2"],
            capture_output=True, text=True, check=False)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        report = json.loads(finished.stdout)
        self.assertGreater(report["sharp after s"], 0)
        self.assertGreater(report["standing, width px"], 360)
        for stream in ("moving", "standing"):
            self.assertGreater(report[f"{stream} stream, pictures/s"], 0)
            self.assertGreaterEqual(report[f"{stream} stream, width px"], 200)


if __name__ == "__main__":
    unittest.main()
