# SPDX-License-Identifier: Apache-2.0
"""A long run that is stopped goes on where it was, and no part of the checks hides another."""

import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import long_run
import parts
from long_run import Part, Record, Step

FOLDER = pathlib.Path(__file__).parent
# Runs three steps, of which the second waits; says what it covers.
STOPPED = """
import sys
import long_run
from long_run import Part, Record, Step
commands = long_run.Commands()
commands.stop_on_signals()
wait = sys.argv[2]
part = Part("p", "", "seeds", lambda: [Step("a", ["true"], 5), Step("b", ["sleep", wait], 5),
                                       Step("c", ["true"], 5)])
try:
    long_run.run(part, Record(sys.argv[1], "now"), commands,
                 lambda text: print(text, flush=True))
except long_run.Stopped:
    sys.exit(130)
"""


class LongRun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name, "passed.json")
        self.said = []

    def run_part(self, commands, source="now"):
        part = Part("p", "", "steps",
                    lambda: [Step(name, command) for name, command in commands.items()])
        return long_run.run(part, Record(self.file, source), long_run.Commands(),
                            self.said.append)

    def test_steps_that_passed_are_not_run_again(self):
        marks = self.file.with_name("marks")
        mark = ["bash", "-c", f"echo x >> {marks}"]
        self.assertFalse(self.run_part({"a": mark, "b": ["false"]}))
        self.assertIn("p: 1 of 2 steps covered; b FAILED: false", self.said)
        self.assertTrue(self.run_part({"a": mark, "b": ["true"]}))
        self.assertEqual(marks.read_text(), "x\n")
        self.assertEqual(self.said[-1], "p: 2 of 2 steps")

    def test_other_sources_begin_anew(self):
        self.assertTrue(self.run_part({"a": ["true"]}))
        self.assertTrue(self.run_part({"a": ["true"]}, source="later"))
        self.assertEqual(self.said, ["p: 0 of 1 steps covered before", "p: 1 of 1 steps"] * 2)

    def test_documents_are_no_sources(self):
        root = self.file.parent

        def change(name):
            root.joinpath(name).write_text(f"{name} {len(list(root.iterdir()))}")

        def git(*words):
            subprocess.run(["git", "-c", "user.name=n", "-c", "user.email=e", *words], cwd=root,
                           check=True, capture_output=True)

        def commit(name):
            change(name)
            git("add", name)
            git("commit", "-m", name)
            return long_run.source_of(root)
        git("init")
        first = commit("a.cpp")
        self.assertEqual(commit("a.md"), first)
        self.assertNotEqual(commit("b.cpp"), first)
        change("a.md")
        self.assertNotIn("changed", long_run.source_of(root))
        change("a.cpp")
        self.assertIn("changed", long_run.source_of(root))

    def test_a_stop_says_what_is_covered_and_the_rest_comes_later(self):
        def start(wait_s):
            return subprocess.Popen([sys.executable, "-B", "-c", STOPPED, str(self.file), wait_s],
                                    cwd=FOLDER, stdout=subprocess.PIPE, text=True)
        for stop in (signal.SIGINT, signal.SIGTERM):
            first = start("600")
            heard = next(line for line in first.stdout if "p: 5 of 15" in line)
            self.assertIn("seeds", heard)
            first.send_signal(stop)
            output, _ = first.communicate(timeout=60)
            self.assertEqual(first.returncode, 130)
            self.assertIn("p: 5 of 15 seeds covered; stopped in b", output)
        output, _ = start("0").communicate(timeout=60)
        self.assertEqual(output.splitlines()[0], "p: 5 of 15 seeds covered before")
        self.assertEqual(output.splitlines()[-1], "p: 15 of 15 seeds")

    def test_every_part_has_a_name_of_its_own_and_says_what_it_is(self):
        names = [part.name for part in parts.PARTS]
        self.assertEqual(len(names), len(set(names)))
        self.assertTrue(all(part.text and part.unit for part in parts.PARTS))
        seeds = next(part for part in parts.PARTS if part.name == "seeds-walk").steps()
        self.assertGreaterEqual(sum(step.covers for step in seeds), 5000)
        first = [int(step.command[-2]) for step in seeds]
        self.assertEqual(len(first), len(set(first)))


if __name__ == "__main__":
    unittest.main()
