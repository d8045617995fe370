#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""serving.py measures what it says: many clients are served with the atlases of one, and several
displays with the structures of one."""

import json
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [sys.argv.pop(1), sys.argv.pop(1)]
# A frame that is measured may have been built before, or be traced after it is counted.
AT_THE_ENDS = 2 / 9


class ServingTest(unittest.TestCase):
    def test_one_trace_and_one_encode_for_all(self):
        script = pathlib.Path(__file__).with_name("serving.py")
        finished = subprocess.run(
            ["/usr/bin/python3", script, *PROGRAMS, "--json", "--size", "160x90", "--rate", "3",
             "--seconds", "3", "--clients", "1,3"], capture_output=True, text=True, check=False)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        report = json.loads(finished.stdout)
        one, three = report["clients"]
        for row in (one, three):
            self.assertLessEqual(row["traced_per_frame"], 1 + AT_THE_ENDS)
            self.assertLessEqual(row["encoded_per_frame"], 1 + AT_THE_ENDS)
            self.assertGreater(row["atlas_bytes"], 1000)
        self.assertGreater(three["sent_per_atlas"], one["sent_per_atlas"])
        single, several = report["displays"]
        self.assertEqual(len(several["displays"]), 4)
        for row in (single, several):
            self.assertLessEqual(row["builds_per_frame"], 1 + AT_THE_ENDS)
            self.assertLessEqual(row["uploads_per_frame"], 1 + AT_THE_ENDS)


if __name__ == "__main__":
    unittest.main()
