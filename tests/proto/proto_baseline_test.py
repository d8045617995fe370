# SPDX-License-Identifier: Apache-2.0
"""The list of what protos declared: before 1.0 it follows them, from 1.0 on it binds them."""

import contextlib
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

import proto_baseline

PROTOC = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else "protoc"
BEFORE_1, AFTER_1 = "0.9", "1.4"


class Baseline(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.baseline = self.root / "proto" / "baseline.txt"
        (self.root / "proto" / "viewloom" / "v1").mkdir(parents=True)
        self.set_version(BEFORE_1)
        self.declare("int32 x = 1;")
        self.tell("nothing yet")
        self.assertEqual(self.run_program("--update")[0], 0)

    def set_version(self, version):
        (self.root / "CMakeLists.txt").write_text(f"project(viewloom VERSION {version}.0)\n",
                                                  encoding="utf-8")

    def declare(self, fields, package="v1"):
        file = self.root / "proto" / "viewloom" / package / "a.proto"
        file.parent.mkdir(exist_ok=True)
        file.write_text(f'syntax = "proto3";\npackage viewloom.{package};\n'
                        f"message Thing {{ {fields} }}\n", encoding="utf-8")

    def tell(self, text):
        (self.root / "CHANGELOG.md").write_text(f"# Changes\n\n## New\n\n- {text}\n\n## Old\n\n"
                                                "- `Thing` is new.\n", encoding="utf-8")

    def commit(self):
        git = ["git", "-c", "user.name=test", "-c", "user.email=test@localhost", "-c",
               "commit.gpgsign=false"]
        for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "Change"]):
            subprocess.run([*git, *words], cwd=self.root, check=True)

    def run_program(self, *options):
        """(exit code, what was printed)"""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            code = proto_baseline.main(["--root", str(self.root), "--protoc", PROTOC, *options])
        return code, printed.getvalue()

    def assert_ends(self, code, words, *options):
        ended, printed = self.run_program(*options)
        self.assertEqual(ended, code, printed)
        self.assertIn(words, printed)

    def test_an_addition_is_recorded_without_more(self):
        self.declare("int32 x = 1; int32 y = 2;")
        self.assert_ends(1, "+  2 int32 y")
        self.assert_ends(0, "wrote proto/baseline.txt", "--update")
        self.assertEqual(self.run_program(), (0, ""))

    def test_before_1_a_break_is_recorded_once_the_changes_tell_it(self):
        self.declare("int64 x = 1;")
        listed = self.baseline.read_bytes()
        self.assert_ends(1, "incompatible: viewloom.v1.Thing: x was of type int32, now int64")
        self.assert_ends(1, "say in the newest section of CHANGELOG.md what changed in Thing",
                         "--update")
        self.assertEqual(self.baseline.read_bytes(), listed)
        self.tell("`Thing.x` has 64 bits.")
        self.assert_ends(0, "wrote", "--update")
        self.assertEqual(self.run_program(), (0, ""))

    def test_from_1_on_a_break_is_refused(self):
        self.set_version(AFTER_1)
        self.assert_ends(0, "the lists of earlier commits were not compared")  # there are none
        self.declare("int64 x = 1;")
        self.tell("`Thing.x` has 64 bits.")
        for options in ([], ["--update"]):
            self.assert_ends(1, "refused from 1.0 on", *options)

    def test_from_1_on_a_list_that_is_edited_hides_nothing(self):
        self.set_version(AFTER_1)
        self.commit()
        self.declare("int64 x = 1;")
        self.baseline.write_text(self.baseline.read_text().replace("int32 x", "int64 x"))
        self.assert_ends(1, "refused from 1.0 on")
        self.commit()
        self.assert_ends(1, "refused from 1.0 on")
        self.declare("int32 x = 1;")
        self.baseline.unlink()
        self.declare("int64 x = 1;")
        self.assert_ends(1, "refused from 1.0 on", "--update")

    def test_from_1_on_what_was_before_it_does_not_bind(self):
        self.commit()
        self.declare("int64 x = 1;")
        self.tell("`Thing.x` has 64 bits.")
        self.assert_ends(0, "wrote", "--update")
        self.commit()
        self.set_version(AFTER_1)
        self.commit()
        self.assertEqual(self.run_program(), (0, ""))

    def test_from_1_on_additions_and_a_new_package_are_recorded(self):
        self.set_version(AFTER_1)
        self.commit()
        self.declare("int32 x = 1; int32 y = 2;")
        self.declare("int64 x = 1;", "v2")
        self.assert_ends(1, "is not that of the protos")
        self.assert_ends(0, "wrote", "--update")
        self.commit()
        self.assertEqual(self.run_program(), (0, ""))
        self.declare("int32 x = 1;")
        self.assert_ends(1, "y is removed")

    def test_a_list_that_cannot_be_read_says_where(self):
        self.baseline.write_text("message viewloom.v1.Thing (a.proto)\n<<<<<<< HEAD\n")
        self.assert_ends(1, "line 2 declares nothing: '<<<<<<< HEAD'")


if __name__ == "__main__":
    unittest.main()
