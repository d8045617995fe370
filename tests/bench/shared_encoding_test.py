# SPDX-License-Identifier: Apache-2.0
"""shared_encoding.py measures what it says: eight viewers of one display get the same bytes, from
one encoding of each atlas. Arguments: viewloomd, viewloom."""
import json
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [sys.argv.pop(1), sys.argv.pop(1)]
DISPLAY = {"quilt": {"columns": 5, "rows": 4, "size": {"width": 640, "height": 480}}}


class SharedEncoding(unittest.TestCase):
    def rows(self, *more):
        program = pathlib.Path(__file__).with_name("shared_encoding.py")
        run = subprocess.run(
            [sys.executable, program, *PROGRAMS, "--viewers", "1,8", "--rounds", "1", "--seconds",
             "2", "--fps", "3", "--size", "160x90", "--display", json.dumps(DISPLAY), *more,
             "--json"], capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def judge(self, rows):
        self.assertEqual([row["viewers"] for row in rows], [1, 8])
        for row in rows:
            self.assertGreater(row["atlases"], 0)
            self.assertEqual(row["encodes per atlas"], 1)
            self.assertEqual(row["pictures coded per picture"], 1)
            self.assertEqual(row["atlases of different bytes"], 0)
            self.assertGreater(row["encode ms"], 0)
        one, eight = rows
        self.assertGreater(eight["received per atlas"], 4 * one["received per atlas"])

    def test_counts_encodings_of_video(self):
        self.judge(self.rows())

    def test_counts_encodings_of_chained_video(self):
        self.judge(self.rows("--chained"))


if __name__ == "__main__":
    unittest.main()
