# SPDX-License-Identifier: Apache-2.0
"""A search of a target goes on where it was until what the target is built from changes."""

import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import fuzz_record
import fuzz_step
from fuzz_record import FuzzRecord, Searched
from fuzz_sources import FuzzSources, without_comments

FOLDER = pathlib.Path(__file__).parent
ROOT = FOLDER.parents[1]
# A fuzzer that executes 6 million inputs at once.
FUZZER = """#!/bin/bash
echo x >> "$0.calls"
echo "stat::number_of_executed_units: ${FUZZER_COUNT:-6000000}" >&2
exit ${FUZZER_STATUS:-0}
"""
# Two targets: one reads by a header and its source, the other by a source without a header.
TREE = {
    "CMakePresets.json": '{"configurePresets": [{"name": "release", "cacheVariables": {}},'
                         ' {"name": "fuzz", "cacheVariables": {"VIEWLOOM_FUZZ": "ON"}}]}',
    "tests/fuzz/fuzz_targets.cpp": '    FuzzTarget{"link", fuzzLink, linkSeeds},\n'
                                   '    FuzzTarget{"call", fuzzCall, callSeeds},\n',
    "tests/fuzz/targets.h": "bool fuzzLink(FuzzBytes bytes);\nbool fuzzCall(FuzzBytes bytes);\n",
    "tests/fuzz/link_target.cpp": '#include "access/link.h"\n#include "fuzz/targets.h"\n'
                                  "bool fuzzLink(FuzzBytes bytes) {}\n",
    "tests/fuzz/call_target.cpp": '#include "absl/status/status.h"\n#include "fuzz/targets.h"\n'
                                  '#include "rpc/call.h"\nbool fuzzCall(FuzzBytes bytes) {}\n',
    "server/access/link.h": "// One.\nint link();\n",
    "server/access/link.cpp": '#include "access/link.h"\nint link() { return 1; }\n',
    "server/rpc/call.h": '#include "viewloom/v1/call.pb.h"\nint call();\n',
    "server/rpc/call_offer.cpp": '#include "rpc/call.h"\nint call() { return 2; }\n',
    "server/rpc/other.h": '#include "rpc/call.h"\n',
    "server/rpc/other.cpp": '#include "rpc/other.h"\n',
    "proto/viewloom/v1/call.proto": 'import "viewloom/v1/size.proto";\n',
    "proto/viewloom/v1/size.proto": "message Size {}\n",
}


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, path, text):
        file = self.folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


class State(Folder):
    def setUp(self):
        super().setUp()
        for path, text in TREE.items():
            self.write(path, text)
        self.before = self.states()

    def states(self):
        sources = FuzzSources(self.folder)
        return {target: sources.state_of(target) for target in sources.targets()}

    def changed_by(self, path, text):
        self.write(path, text)
        now = self.states()
        return [target for target in self.before if now[target] != self.before[target]]

    def test_a_target_is_built_from_what_it_includes_and_from_the_sources_of_that(self):
        sources = FuzzSources(self.folder)
        self.assertEqual(sources.targets(), ["call", "link"])
        self.assertEqual(sources.files_of("link"), ["server/access/link.cpp",
                                                    "server/access/link.h",
                                                    "tests/fuzz/link_target.cpp"])
        self.assertEqual(sources.files_of("call"), ["proto/viewloom/v1/call.proto",
                                                    "proto/viewloom/v1/size.proto",
                                                    "server/rpc/call.h",
                                                    "server/rpc/call_offer.cpp",
                                                    "tests/fuzz/call_target.cpp"])

    def test_a_change_begins_the_targets_anew_that_it_reaches(self):
        path = "server/access/link.cpp"
        self.assertEqual(self.changed_by(path, TREE[path].replace("1", "3")), ["link"])

    def test_a_message_begins_the_targets_anew_that_read_it(self):
        self.assertEqual(self.changed_by("proto/viewloom/v1/size.proto", "message S {}"), ["call"])

    def test_sanitizers_begin_all_targets_anew(self):
        path = "CMakePresets.json"
        self.assertEqual(self.changed_by(path, TREE[path].replace("ON", "OFF")), ["call", "link"])

    def test_what_is_elsewhere_begins_nothing_anew(self):
        for path, text in (("server/rpc/other.cpp", "int other();"),
                           ("tests/fuzz/targets.h", "bool fuzzMore(FuzzBytes bytes);"),
                           ("tests/fuzz/more_target.cpp", "bool fuzzMore(FuzzBytes bytes) {}"),
                           ("tests/fuzz/fuzz_targets.cpp", '    FuzzTarget{"more", fuzzMore, a},\n'
                            + TREE["tests/fuzz/fuzz_targets.cpp"]),
                           ("server/access/link.h", "// Two.\n\nint\nlink();")):
            self.assertEqual(self.changed_by(path, text), [], path)

    def test_literals_are_no_comments(self):
        self.assertEqual(without_comments('f(1\'000);  // it\'s\n  g("a // b", \'"\') /* c */;'),
                         'f(\n1\'000\n);\ng(\n"a // b"\n,\n\'"\'\n)\n;')
        self.assertNotEqual(without_comments('"http://a"'), without_comments('"http://b"'))

    def test_every_target_of_the_tree_has_its_source_and_more(self):
        sources = FuzzSources(ROOT)
        for target in sources.targets():
            files = sources.files_of(target)
            self.assertIn(sources.file_of(target), files)
            self.assertTrue(any(path.startswith(("server/", "client/")) for path in files), target)


class Step(Folder):
    def setUp(self):
        super().setUp()
        self.fuzzer = self.folder / "tests/fuzz/zstd_fuzzer"
        self.write("tests/fuzz/zstd_fuzzer", FUZZER)
        self.fuzzer.chmod(0o755)

    def step(self, **environment):
        return subprocess.run(
            [sys.executable, "-B", FOLDER / "fuzz_step.py", self.folder, self.folder, "zstd", "1"],
            check=False, capture_output=True, text=True, env={**os.environ, **environment})

    def calls(self):
        return self.fuzzer.with_name("zstd_fuzzer.calls").read_text().count("x")

    def test_a_target_is_searched_by_all_processors_until_it_is_enough(self):
        millions = 6 * os.cpu_count()
        said = self.step().stdout
        self.assertIn(f"zstd: {millions},000,000 executions in", said)
        self.assertIn("searched enough", said)
        calls = self.calls()
        self.assertEqual(calls, os.cpu_count() * (1 if millions >= 10 else 2))
        self.assertIn("searched enough", self.step().stdout)
        self.assertEqual(self.calls(), calls)

    def test_a_crash_ends_the_search_and_is_counted(self):
        crashed = self.step(FUZZER_STATUS="77")
        self.assertEqual(crashed.returncode, 77)
        self.assertIn("stat::", crashed.stderr)
        row, = json.loads((self.folder / "progress/zstd.json").read_text())
        self.assertEqual(row["failures"], os.cpu_count())

    def test_a_fuzzer_that_executes_nothing_is_an_error(self):
        nothing = self.step(FUZZER_COUNT="0")
        self.assertEqual(nothing.returncode, 1)
        self.assertIn("zstd: nothing was executed", nothing.stderr)

    def test_executions_are_those_of_the_last_search(self):
        self.assertEqual(fuzz_step.executed(b"stat::number_of_executed_units:  17\n"), 17)
        self.assertEqual(fuzz_step.executed(b"no statistics"), 0)


class Record(Folder):
    TODAY = datetime.date(2026, 11, 27)

    def add(self, state, searched, days_ago=0):
        FuzzRecord(self.folder, "zstd").add(state, searched,
                                            self.TODAY - datetime.timedelta(days=days_ago))

    def test_states_are_counted_apart_and_days_together(self):
        self.add("one", Searched(4_000_000, 60), days_ago=40)
        self.add("one", Searched(1_000_000, 60), days_ago=29)
        self.add("one", Searched(2_000_000, 60), days_ago=29)
        self.add("two", Searched(5, 7200, 1))
        record = FuzzRecord(self.folder, "zstd")
        self.assertEqual(record.of_state("one"), Searched(7_000_000, 180))
        self.assertEqual(record.of_state("one").share(), 0.7)
        self.assertEqual(record.of_state("two").share(), 1)
        self.assertEqual(record.of_state("three"), Searched())
        self.assertEqual(record.of_last_days(self.TODAY), Searched(3_000_005, 7320, 1))

    def test_a_file_of_an_earlier_form_counts_nothing(self):
        self.write("progress/zstd.json", '{"source": "1", "executions": 9, "cpu_s": 1}')
        self.assertEqual(FuzzRecord(self.folder, "zstd").of_state("1"), Searched())
        self.add("1", Searched(3, 1))
        self.assertEqual(FuzzRecord(self.folder, "zstd").of_state("1"), Searched(3, 1))

    def test_the_summary_says_how_far_each_target_is(self):
        self.add("one", Searched(2_500_000, 90))
        FuzzRecord(self.folder, "link").add("two", Searched(10_000_000, 3600), self.TODAY)
        FuzzRecord(self.folder, "jwt").add("six", Searched(10_000_000, 3600, 1), self.TODAY)
        lines = list(fuzz_record.summary(
            self.folder, {"zstd": "one", "link": "two", "jwt": "six"}, self.TODAY))
        self.assertEqual(lines[1].split(), ["zstd", "2,500,000", "1.5", "0", "25%"])
        self.assertEqual(lines[3].split(), ["jwt", "10,000,000", "60.0", "1", "100%"])
        self.assertIn("1 of 3 targets have reached it", lines[4])
        self.assertEqual(lines[5], "last 30 days, all states: 22,500,000 executions in 2.0 CPU "
                                   "hours, 1 failures")


if __name__ == "__main__":
    unittest.main()
