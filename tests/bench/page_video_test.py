# SPDX-License-Identifier: Apache-2.0
"""page_video.py measures what it says: both kinds show the same pictures, and H.264 takes fewer
bytes. Arguments: viewloomd, viewloom, code_stack."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

CHROMIUM = "/usr/bin/chromium"
PROGRAM = pathlib.Path(__file__).with_name("page_video.py")


@unittest.skipUnless(os.path.exists(CHROMIUM), f"there is no {CHROMIUM}")
class PageVideo(unittest.TestCase):
    def test_measures_both_kinds(self):
        run = subprocess.run(
            [sys.executable, PROGRAM, *ARGUMENTS, "--atlases", "2", "--rounds", "1", "--count", "5",
             "--json"], capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        figures = json.loads(run.stdout)
        jpeg, video = figures["JPEG"], figures["H.264"]
        self.assertGreater(jpeg["PSNR of luma, dB"], 35)
        self.assertLess(abs(jpeg["PSNR of luma, dB"] - video["PSNR of luma, dB"]), 3)
        self.assertLess(video["KB"], jpeg["KB"] / 2)
        self.assertIn(video["uploaded by"], ("planes", "texImage2D", ""))
        for kind in (jpeg, video):
            for name in ("decode ms", "upload ms", "pipelined, Hz", "one after the other, Hz"):
                self.assertGreater(kind[name], 0)


if __name__ == "__main__":
    ARGUMENTS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
