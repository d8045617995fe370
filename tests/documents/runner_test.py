# SPDX-License-Identifier: Apache-2.0
"""Plants a mistake in a small document and asks for exactly the sentence that tells it."""

import contextlib
import io
import os
import socket
import tempfile
import threading
import unittest
from unittest import mock

import planted_programs
import served
import server_lists
import whole_tree
from blocks import read_blocks
from document_run import DocumentRun
from expected_output import missing_line
from planted_programs import PlantedPrograms
from running import Failure
from short_forms import Short

# The rules are tried while other tests use the default ports: what answers there is not asked.
NOBODYS_ADDRESS = "127.0.0.1:1"
REASON = "*The tests do not run this block: it needs Docker.*\n\n"


def fenced(text, language=""):
    return f"```{language}\n{text}\n```\n"


class PlantedCase(unittest.TestCase):
    """`problems` runs a document. `named` is what was found before, `skipped` why it ended."""

    def problems(self, text, serve=planted_programs.SERVES, patience_s=20,
                 document="README.md"):
        planted = PlantedPrograms(serve)
        self.addCleanup(planted.close)
        served.PORTS = ()
        server_lists.ADDRESS = NOBODYS_ADDRESS
        run = DocumentRun(document, text, planted.checkout, planted.build, patience_s)
        with contextlib.redirect_stdout(io.StringIO()):
            self.named = list(run.check_names())
            problems = list(run.run())
        self.skipped = run.skipped
        return problems

    def expect_one(self, problems, *words):
        self.assertEqual(len(problems), 1, problems)
        for word in words:
            self.assertIn(word, problems[0])


class Commands(PlantedCase):
    def test_a_good_document_passes(self):
        text = fenced("export NAME=x && mkdir sub && cd sub\n"
                      "test $NAME = x && test ${PWD##*/} = sub\nviewloom watch --count 1")
        self.assertEqual((self.problems(text), self.named), ([], []))

    def test_a_new_block_keeps_exports_and_starts_in_the_first_folder(self):
        text = fenced("export NAME=x; cd client") + fenced("test $NAME = x && test -d client")
        self.assertEqual(self.problems(text), [])

    def test_an_option_that_does_not_exist_is_found(self):
        problems = self.problems(fenced("viewloom watch --cuont 1"))
        self.expect_one(self.named, "README.md:2: viewloom watch has no option --cuont")
        self.expect_one(problems, "exit code 2", "cannot do that")

    def test_an_option_in_a_block_that_does_not_run_is_found(self):
        text = REASON + fenced("docker run --rm viewloom watch --cuont 1")
        self.assertEqual(self.problems(text), [])
        self.expect_one(self.named, "viewloom watch has no option --cuont")

    def test_an_option_in_prose_and_one_of_a_program_of_ours_are_found(self):
        self.problems("`viewloom watch --cuont 1` watches.\n")
        self.expect_one(self.named, "README.md:1:", "--cuont")
        self.problems(REASON + fenced("/usr/bin/python3 client/tool.py --size 1 --sice 1"))
        self.expect_one(self.named, "client/tool.py has no option --sice")

    def test_a_subcommand_that_does_not_exist_is_found(self):
        self.expect_one(self.problems(fenced("viewloom wacth --count 1")), "exit code 2")
        self.expect_one(self.named, "viewloom has no subcommand \"wacth\"")

    def test_a_command_that_fails_is_found_with_what_it_said(self):
        self.expect_one(self.problems(fenced("true\necho some words; false")), "README.md:1",
                        "exit code 1", "some words")

    def test_a_missing_file_is_found(self):
        problems = self.problems(fenced("cat client/gone.txt"))
        self.expect_one(self.named, "there is no client/gone.txt")
        self.expect_one(problems, "exit code 1")

    def test_a_wrong_line_in_a_block_that_does_not_run_is_found(self):
        self.assertEqual(self.problems(REASON + fenced("docker run 'viewloom")), [])
        self.assertIn("README.md:4", self.named[0])

    def test_a_command_that_does_not_end_is_found_and_ended(self):
        with tempfile.NamedTemporaryFile("r") as file:
            text = fenced(f"echo $$ >{file.name}; exec sleep 1000")
            self.expect_one(self.problems(text, patience_s=1), "did not end within 1 s")
            with self.assertRaises(ProcessLookupError):
                os.kill(int(file.read()), 0)

    def test_a_file_that_is_not_written_is_found(self):
        self.assertEqual(self.problems(fenced("viewloom watch --count 1 --out here")), [])
        self.expect_one(self.problems(fenced("viewloom watch --count 1 --out nowhere")),
                        "wrote nothing to nowhere")

    def test_a_shown_line_that_is_not_said_is_found(self):
        text = fenced("$ viewloom watch --count 1\natlas 9x9 of ... views", "console")
        self.assertEqual(self.problems(text), [])
        text = fenced("$ viewloom watch --count 1\natlas 9x9 of ... tiles", "console")
        self.expect_one(self.problems(text), "did not say: atlas 9x9 of ... tiles")

    def test_only_npm_without_its_registry_is_skipped(self):
        offline = "npm() { echo ENOTFOUND; return 1; }; npm ci"
        with mock.patch.dict(os.environ, {"VIEWLOOM_REQUIRE_NODE": "0"}):
            self.assertEqual(self.problems(fenced(offline) + fenced("true")), [])
            self.assertIn("ENOTFOUND", self.skipped)
            self.assertEqual(len(self.problems(fenced(offline) + fenced("false"))), 1)
            self.assertEqual(len(self.problems(fenced(offline.replace("ENOT", "")))), 1)
        with mock.patch.dict(os.environ, {"VIEWLOOM_REQUIRE_NODE": "1"}):
            self.assertEqual(len(self.problems(fenced(offline))), 1)

    def test_after_three_failures_the_rest_does_not_run(self):
        problems = self.problems(5 * fenced("false"))
        self.assertEqual(len(problems), 4)
        self.assertEqual(problems[-1], "README.md: the blocks after line 7 did not run")

    def test_a_program_that_fails_and_broken_data_are_found(self):
        self.expect_one(self.problems(fenced('{"a": [1}', "json")), "is no JSON")
        self.expect_one(self.problems(fenced("config = ", "toml")), "is no TOML")
        self.expect_one(self.problems(fenced("const a = ;", "js")), "exit code 1", "SyntaxError")
        self.expect_one(self.problems(fenced("float a = b;", "glsl")), "undeclared identifier")


class Servers(PlantedCase):
    """`viewloomd serve`, which has no end."""

    SERVE = fenced("viewloomd serve\nsleep 0.1")

    def test_a_server_serves_until_the_end_of_its_block(self):
        self.assertEqual(self.problems(self.SERVE), [])

    def test_a_story_keeps_its_server_for_the_blocks_that_follow(self):
        text = fenced("viewloomd serve") + fenced("kill -0 $(cat pid)")
        serve = "echo $$ >pid\n" + planted_programs.SERVES
        self.assertEqual(self.problems(text, serve, document="deploy/lab.md"), [])
        self.expect_one(self.problems(text, serve), "exit code 1")

    def test_a_server_of_a_story_that_fails_after_ctrl_c_is_found(self):
        self.expect_one(self.problems(self.SERVE, planted_programs.WRONG_EXIT,
                                      document="deploy/lab.md"), "exit code 3 after Ctrl-C")

    def test_a_setting_that_does_not_exist_is_found(self):
        self.assertEqual(self.problems(fenced('config = "a"', "toml")), [])
        self.expect_one(self.problems(fenced("[limits]\nsize = 1", "toml")),
                        "viewloomd has no setting limits.size")

    def test_a_server_that_never_gets_ready_is_found_and_ended(self):
        problems = self.problems(self.SERVE, planted_programs.NEVER_READY, patience_s=1)
        self.expect_one(problems, "waited 1 s for its sign (output viewloomd listening")

    def test_a_server_that_ends_is_found(self):
        self.expect_one(self.problems(self.SERVE, planted_programs.ENDS_AT_ONCE), "exit code 2",
                        "address already in use")

    def test_a_server_that_fails_after_ctrl_c_is_found(self):
        self.expect_one(self.problems(self.SERVE, planted_programs.WRONG_EXIT),
                        "exit code 3 after Ctrl-C")

    def test_a_port_that_is_taken_is_named(self):
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            one.listen()
            port = one.getsockname()[1]
            with self.assertRaisesRegex(Failure, f"port {port} is taken"):
                served.wait_for_free_ports([port], patience_s=0)


class HalfAnswers(unittest.TestCase):
    """A server that ends hangs up, before its answer or within it: then it has no displays."""

    def displays_of(self, answer):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            def answer_one():
                connection, _ = listener.accept()
                with connection:
                    connection.recv(65536)
                    connection.sendall(answer)
            thread = threading.Thread(target=answer_one, daemon=True)
            thread.start()
            address = f"127.0.0.1:{listener.getsockname()[1]}"
            with mock.patch.object(server_lists, "ADDRESS", address):
                displays = server_lists.ServerLists(workplace=None).read("displays")
            thread.join()
        return displays

    def test_no_displays_are_listed(self):
        head = b"HTTP/1.1 200 OK\r\n"
        for answer in (b"", b"HTTP/1.1 2", head + b"\r\n", head + b"\r\n{\"displays\": [",
                       head + b"Content-Length: 99\r\n\r\n{\"displays\""):
            with self.subTest(answer):
                self.assertEqual(self.displays_of(answer), [])

    def test_those_of_a_whole_answer_are(self):
        body = b'{"displays": [{"id": "7", "atlas_count": 3}]}'
        self.assertEqual(self.displays_of(b"HTTP/1.1 200 OK\r\n\r\n" + body),
                         [{"id": "7", "atlas_count": 3}])


class Reading(unittest.TestCase):
    def test_commands_continue_over_lines_and_have_their_output(self):
        block, = read_blocks("a.md", fenced("$ one \\\n  two\nsaid\n$ three # a comment"))
        self.assertEqual([(c.line, c.text, c.output) for c in block.commands()],
                         [(2, "one \\\n  two", ("said",)), (5, "three # a comment", ())])

    def test_a_reason_counts_only_right_before_its_block(self):
        blocks = read_blocks("a.md", REASON + fenced("a") + fenced("b"))
        self.assertEqual([block.reason for block in blocks], ["it needs Docker", ""])

    def test_numbers_may_differ_and_words_may_not(self):
        said = "range  1.5 .. 2 m\nwarning   past the source look views 0-3 by 12 %"
        shown = ["  ...", "  range 7 .. 2.25 m", "warning ... by 3 %"]
        self.assertIsNone(missing_line(shown, said))
        self.assertEqual(missing_line(["range 7 .. 2.25 km"], said), "range 7 .. 2.25 km")
        self.assertEqual(missing_line(["warning ...", "range 1 .. 2 m"], said), "range 1 .. 2 m")

    def test_shown_json_has_the_names_that_came(self):
        self.assertIsNone(missing_line(['{"a": [{"b": 1}],', '"c": 2}'],
                                       '{"a":[{"b":5},{"b":6}],"c":0}'))
        self.assertIsNotNone(missing_line(['{"a": 1}'], '{"b": 1}'))


class WholeTree(unittest.TestCase):
    def problems(self, documents, tested=("a.md",), forms=(), beside=()):
        return list(whole_tree.problems_of(documents, tested, forms, beside))

    def test_fifteen_blocks_may_not_run_and_sixteen_are_too_many(self):
        block = REASON + fenced("docker build .")
        self.assertEqual(self.problems({"a.md": 15 * block}), [])
        self.assertEqual(self.problems({"a.md": 16 * block}),
                         ["the tests do not run 16 blocks, accepted are 15: run some of them"])

    def test_each_document_with_commands_has_a_test(self):
        self.assertEqual(len(self.problems({"a.md": fenced("ls"), "b.md": fenced("ls")})), 1)
        self.assertEqual(len(self.problems({"a.md": fenced("said", "text")})), 1)

    def test_each_block_says_what_it_is(self):
        self.assertEqual(len(self.problems({"a.md": fenced("ls") + fenced("ls", "fish")})), 1)
        for hidden in ("$ ls", "viewloom watch demo", "sudo ls", "tests/run.sh -L unit"):
            self.assertEqual(len(self.problems({"a.md": fenced("a") + fenced(hidden, "text")})), 1)
        self.assertEqual(self.problems({"a.md": fenced("a") + fenced("viewloomd can run", "text")}),
                         [])

    def test_a_file_that_prose_names_and_that_is_not_there_is_found(self):
        found = whole_tree.missing_files(
            {"a.md": "`tests/documents/blocks`, `tests/NAME.py`, `a/b`\n\n`tests/gone.py`\n"},
            whole_tree.ROOT)
        self.assertEqual(list(found), ["a.md:3: there is no tests/gone.py"])

    def test_a_short_form_that_nothing_needs_is_found(self):
        form = Short(("a.md",), "ls -R", "ls", "it is slow")
        self.assertEqual(self.problems({"a.md": fenced("ls -R")}, forms=[form]), [])
        self.assertEqual(len(self.problems({"a.md": fenced("ls")}, forms=[form])), 1)
        self.assertEqual(len(self.problems({"a.md": fenced("ls")}, beside=[("a.md", "cat")])), 1)


if __name__ == "__main__":
    unittest.main()
