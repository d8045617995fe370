#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""viewloom-bench prints what it promises, and its contestants mean the same surfaces."""

import json
import subprocess
import sys
import unittest

PROGRAM = ""

# A surface found half a px of disparity away, or not at all. Silhouettes are a matter of
# definition: samples of a px, planes and triangles end within a px of each other.
DIFFER_SHARE_MAX = 0.02


def run(*arguments):
    finished = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)
    if finished.returncode != 0:
        raise AssertionError(finished.stderr)
    return json.loads(finished.stdout)


class BenchTest(unittest.TestCase):
    def test_trace(self):
        report = run("trace", "--json", "--rounds", "1", "--only",
                     "clutter x2, portrait quilt, normal")
        self.assertRegex(report["date"], r"^\d{4}-\d\d-\d\d$")
        (load,) = report["loads"]
        self.assertEqual(load["rays"], 3360 * 3360)
        self.assertAlmostEqual(load["disparity_span_px"], 18, delta=0.01)
        self.assertEqual(load["method"], "sweep" if "walk" in load["build_ms"] else "walk")
        contestants = {"viewloom", "floor", "copy", "dda", "hiz", "rows", "runs"}
        self.assertLessEqual(contestants, set(load["build_ms"]))
        for name, share in load["differ_share"].items():
            self.assertLess(share, DIFFER_SHARE_MAX, name)
        self.assertGreaterEqual(load["visits"]["mean"], 1)
        self.assertGreaterEqual(load["visits"]["max"], load["visits"]["p99"])

    def test_build(self):
        report = run("build", "--json", "--rounds", "1", "--only", "smooth x1")
        (load,) = report["loads"]
        self.assertGreater(load["build_ms"]["viewloom"], 0)
        self.assertGreater(load["build_ms"]["copy"], 0)

    def test_a_load_that_does_not_exist(self):
        finished = subprocess.run([PROGRAM, "trace", "--only", "no such load"],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(finished.returncode, 1)
        self.assertIn("no such load", finished.stderr)
        self.assertIn("clutter x2, portrait quilt, normal", finished.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
