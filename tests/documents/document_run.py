# SPDX-License-Identifier: Apache-2.0
"""Runs the blocks of one document, in order, and says what each command took."""

import os
import re
import shlex
import subprocess
import time

import snippets
from blocks import code_spans, read_blocks, wrong_languages
from endless import sign_of, written
from expected_output import missing_line
from known_names import Programs, missing_files, simple_commands, unknown_options
from running import Failure, Running, cpu_seconds, file_names
from served import Served
from short_forms import BESIDE, SUITE, shortened
from workplace import Workplace

PATIENCE_S = 90
# One story each: what a block starts runs until the end of the document.
STORIES = ("deploy/access.md", "deploy/internet.md", "deploy/lab.md", "deploy/lan.md")
# After so many failures the rest of a document waits for the next run, so that no test takes long.
FAILURES_MAX = 3
ASKS_GIT = re.compile(r"^/usr/bin/python3 tests/tidy|^tests/full\.sh", re.MULTILINE)


def is_without_registry(failure):
    """True if a command failed only because npm or its registry is out of reach."""
    return (os.environ.get("VIEWLOOM_REQUIRE_NODE") != "1"
            and re.search(r"\bnpm (ci|install)\b", failure.command)
            and re.search(r"npm: command not found|ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|network"
                          "|SELF_SIGNED_CERT",
                          failure.said))


class DocumentRun:
    """`used` are the short forms that were needed, `counts` how many blocks ran in which way.
    `skipped` says what this machine lacks."""

    def __init__(self, document, text, checkout, build, patience_s=PATIENCE_S):
        self.document = document
        self._text = text
        self._blocks = read_blocks(document, text)
        self._workplace = Workplace(checkout, build, "export PATH=" in text)
        if ASKS_GIT.search(text):
            self._workplace.make_history()
        self._served = Served(self._workplace)
        self._programs = Programs(self._workplace.viewloomd, self._workplace.viewloom)
        self._patience_s = patience_s
        self._kept = {}
        self._keeps_blocks = document in STORIES
        self.used = []
        self.skipped = ""
        self.counts = {"run": 0, "shortened": 0, "not run": 0, "programs and data": 0}

    def check_names(self):
        """Sentences about options and files that do not exist, in blocks and in `code`."""
        yield from wrong_languages(self._blocks)
        for block in self._blocks:
            if not block.holds_commands():
                continue
            yield from self._parsed(block)
            for command in block.commands():
                for words in simple_commands(command.text):
                    for problem in (*unknown_options(words, self._programs, self._workplace.root),
                                    *missing_files(words, self._workplace.root)):
                        yield f"{self.document}:{command.line}: {problem}"
        for line, span in code_spans(self._text):
            if not re.match(r"viewloomd? [a-z-]", span):
                continue
            words = span.split()
            for problem in unknown_options(words, self._programs, self._workplace.root):
                yield f"{self.document}:{line}: {problem}"

    def _parsed(self, block):
        for command in block.commands():
            done = subprocess.run(["bash", "-n", "-c", command.text], capture_output=True,
                                  text=True, check=False)
            if done.returncode != 0:
                yield f"{self.document}:{command.line}: {done.stderr}"

    def run(self):
        """Sentences about blocks that failed. Nothing that was started is left."""
        failed_count = 0
        try:
            for block in self._blocks:
                try:
                    self._run_block(block)
                except Failure as failure:
                    if is_without_registry(failure):
                        self.skipped = str(failure)
                        continue
                    yield f"{self.document}:{block.line}: {failure}"
                    failed_count += 1
                finally:
                    if not self._keeps_blocks:
                        self._kill_kept()
                if failed_count == FAILURES_MAX:
                    yield f"{self.document}: the blocks after line {block.line} did not run"
                    break
            try:
                self._stop_kept()
                self._served.stop()
            except Failure as failure:
                yield f"{self.document}: what ran beside the commands: {failure}"
        finally:
            self._kill_kept()
            self._served.kill()
            self._workplace.close()

    def _kill_kept(self):
        for running in self._kept.values():
            running.kill()
        self._kept = {}

    def _stop_kept(self):
        while self._kept:
            self._kept.popitem()[1].stop(self._patience_s)

    def _run_block(self, block):
        self._workplace.forget_state()
        if block.reason:
            self._say(block.line, f"not run: {block.reason}")
            self.counts["not run"] += 1
        elif block.holds_commands():
            self._run_commands(block)
        elif block.language in snippets.CHECKS:
            text = shortened(self.document, block.text, self.used)
            self._served.prepare(text)
            begun = time.monotonic()
            snippets.CHECKS[block.language](self.document, text, self._workplace)
            self._say(block.line, f"{time.monotonic() - begun:5.1f} s  {block.language}")
            self.counts["programs and data"] += 1

    def _run_commands(self, block):
        used_before = len(self.used)
        self._served.prepare(block.text, "server" in self._kept)
        for command in block.commands():
            if SUITE.match(command.text):
                self._say(command.line, f"recognised: {command.text.split()[0]}")
                continue
            text = shortened(self.document, command.text, self.used)
            begun, cpu_begun = time.monotonic(), cpu_seconds()
            self._run_command(command, text)
            self._say(command.line, f"{time.monotonic() - begun:5.1f} s  {text}",
                      cpu_seconds() - cpu_begun)
        if not self._keeps_blocks:
            self._stop_kept()
        self.counts["shortened" if len(self.used) > used_before else "run"] += 1

    def _run_command(self, command, text):
        calls = list(simple_commands(text))
        sign = next(filter(None, (sign_of(self._programs.call_of(words), words)
                                  for words in calls)), None)
        if text.endswith("&"):
            text = text[:-1]  # all commands without an end are in the background
        beside = BESIDE.get((self.document, command.text))
        viewer = self._start(beside, leaves_state=False) if beside else None
        try:
            if sign:
                self._run_endless(text, sign, command.output)
            else:
                self._run_to_its_end(text, command.output, [
                    self._workplace.root / name for words in calls
                    for name in written(self._programs.call_of(words))])
        finally:
            if viewer:
                viewer.kill()

    def _run_to_its_end(self, text, output, files):
        before = {file: file_names(file) for file in files}
        running = self._start(text, leaves_state=True)
        try:
            running.wait(self._patience_s)
            line = missing_line(output, running.said())
            if line is not None:
                running.fail(f"did not say: {line}")
            for file in files:
                if not file.is_file() and file_names(file) == before[file]:
                    running.fail(f"wrote nothing to {file.name}")
        finally:
            running.kill()

    def _start(self, text, leaves_state):
        return Running(text, self._workplace, leaves_state, **self._served.environment())

    def _run_endless(self, text, sign, output):
        if sign.role in self._kept:
            self._kept.pop(sign.role).stop(self._patience_s)
        is_there = self._condition(sign)
        if sign.role == "server":
            self._served.lists.learn(shlex.split(text))
        running = self._start(text, leaves_state=False)
        self._kept[sign.role or text] = running
        running.wait_for(lambda: is_there(running), f"its sign ({sign.kind} {sign.value})".strip(),
                         self._patience_s)
        if output:
            running.wait_for(lambda: missing_line(output, running.said()) is None,
                             f"all of {list(output)}", self._patience_s)
        if not sign.role:
            self._kept.pop(text).stop(self._patience_s)

    def _condition(self, sign):
        """A function of a running command: true once its sign has come."""
        if sign.kind == "files":
            folder = self._workplace.root / sign.value
            before = file_names(folder)
            return lambda _: file_names(folder) - before
        if sign.kind == "stream":
            before = self._served.used_count(sign.value)
            return lambda _: self._served.used_count(sign.value) > before
        if sign.kind == "atlases":
            counts = self._served.atlas_counts()
            return lambda _: any(count > counts.get(display, 0) for display, count in
                                 self._served.atlas_counts().items())
        if sign.kind == "screen":
            self._served.wait_for_black_screen()
            return lambda _: self._served.has_picture()
        if sign.kind == "bridge":
            shown = len(self._served.bridge.shown)
            return lambda _: len(self._served.bridge.shown) > shown
        return lambda running: re.search(sign.value, running.said())

    def _say(self, line, text, cpu_s=None):
        cpu = "" if cpu_s is None else f"  (CPU {cpu_s:.1f} s)"
        print(f"{self.document}:{line}: {text}{cpu}", flush=True)
