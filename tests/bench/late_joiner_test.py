# SPDX-License-Identifier: Apache-2.0
"""late_joiner.py measures what it says: joiners get an atlas and its pixels in each encoding, from
a scene that moves and one that stands, and no sooner than their line carries it. Arguments:
viewloomd, viewloom."""
import json
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [sys.argv.pop(1), sys.argv.pop(1)]
SIZE = {"width": 960, "height": 720}
MBIT = 4


class LateJoiner(unittest.TestCase):
    def test_measures_each_encoding(self):
        program = pathlib.Path(__file__).with_name("late_joiner.py")
        display = {"quilt": {"columns": 8, "rows": 6, "size": SIZE}}
        run = subprocess.run(
            [sys.executable, program, *PROGRAMS, "--rounds", "1", "--size", "160x90", "--fps", "5",
             "--display", json.dumps(display), "--mbit", "0", str(MBIT), "--json"],
            capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = {(row["scene"], row["Mbit/s"], row["encoding"]): row
                for row in json.loads(run.stdout)}
        self.assertEqual(set(rows), {
            (scene, mbit, encoding) for scene in ("moving", "standing") for mbit in (0, MBIT)
            for encoding in ("JPEG", "H.264", "H.264, chained")})
        for (scene, mbit, encoding), row in rows.items():
            with self.subTest(scene=scene, mbit=mbit, encoding=encoding):
                self.assertEqual(row["px"], SIZE["width"] * SIZE["height"])
                self.assertLess(0, row["whole ms"])
                self.assertLess(row["whole ms"], row["decoded ms"])
                jpeg = rows[scene, mbit, "JPEG"]
                for time in ("whole ms", "decoded ms"):
                    self.assertAlmostEqual(row[f"{time} of JPEG"], row[time] / jpeg[time])
                if mbit:
                    self.assertGreater(row["whole ms"], 8 * row["KB"] / mbit)
                if encoding == "H.264":
                    self.assertLess(row["KB"], jpeg["KB"])


if __name__ == "__main__":
    unittest.main()
