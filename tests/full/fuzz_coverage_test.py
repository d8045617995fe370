# SPDX-License-Identifier: Apache-2.0
"""Lines of parsers and checks are counted, and those of nothing else."""

import pathlib
import re
import unittest

import fuzz_coverage
from fuzz_sources import FuzzSources

FOLDER = pathlib.Path(__file__).parent


class FuzzCoverage(unittest.TestCase):
    def test_every_reader_exists(self):
        for pattern in fuzz_coverage.READERS.pattern.split("\n  |"):
            head, _, names = pattern.strip().partition("(")
            folder = FOLDER.parents[1] / head.rpartition("/")[0].strip("/")
            self.assertTrue(folder.is_dir(), folder)
            for name in re.findall(r"[a-z_]+", names.partition(")")[0]):
                self.assertTrue(any(name in file.name for file in folder.glob("*.cpp")), name)

    def test_each_source_of_a_target_is_a_reader_or_none(self):
        paths = fuzz_coverage.built(FuzzSources(FOLDER.parents[1]))
        self.assertEqual(fuzz_coverage.undecided(paths), [])
        self.assertEqual(fuzz_coverage.undecided(["server/web/url.cpp", "server/web/new.cpp"]),
                         ["server/web/new.cpp"])

    def test_a_reader_that_is_not_counted_is_found(self):
        paths = ["server/web/url.cpp", "server/web/host_policy.cpp", "server/core/base/check.cpp"]
        self.assertEqual(fuzz_coverage.missing(paths, [("/x/server/web/url.cpp", 1, 1)]),
                         ["server/web/host_policy.cpp"])

    def test_the_least_covered_file_comes_first(self):
        def file(name, covered):
            return {"filename": name, "summary": {"lines": {"covered": covered, "count": 10}}}
        url, other, policy = (f"/x/server/web/{name}.cpp"
                              for name in ("url", "routes", "host_policy"))
        report = {"data": [{"files": [file(url, 9), file(other, 0), file(policy, 8)]}]}
        self.assertEqual(fuzz_coverage.shares(report), [(policy, 8, 10), (url, 9, 10)])


if __name__ == "__main__":
    unittest.main()
