# SPDX-License-Identifier: Apache-2.0
"""Runs that are stopped and go on: a part is a row of steps, and the steps that passed are kept.

They are kept for one state of the sources. Ctrl-C and SIGTERM end the step that runs. The next
time it is run from its beginning.
"""

import json
import os
import pathlib
import signal
import subprocess
import time
from dataclasses import dataclass, field
from typing import Callable


class Stopped(Exception):
    """Somebody asked for an end."""


@dataclass(frozen=True)
class Step:
    name: str
    command: list
    covers: int = 1  # in the unit of its part


@dataclass(frozen=True)
class Part:
    name: str
    text: str
    unit: str  # what its steps cover: "seeds"
    steps: Callable  # gives the list of steps, once all of `prepare` is done
    prepare: list = field(default_factory=list)  # steps that are run every time, as builds are


class Record:
    """Which steps passed, in a file: {source: {part: {step: seconds}}}."""

    def __init__(self, file, source):
        self._file = pathlib.Path(file)
        self._source = source
        try:
            self._all = json.loads(self._file.read_text())
        except FileNotFoundError:
            self._all = {}

    def passed(self, part):
        return self._all.get(self._source, {}).get(part.name, {})

    def add(self, part, step, seconds):
        steps = self._all.setdefault(self._source, {}).setdefault(part.name, {})
        steps[step] = round(seconds, 1)
        self._file.parent.mkdir(parents=True, exist_ok=True)
        # A whole file or none, whenever this is stopped.
        temporary = self._file.with_suffix(".new")
        temporary.write_text(json.dumps(self._all, indent=1))
        temporary.replace(self._file)


def source_of(root):
    """Names the sources: the last commit that changed more than documents, and whether anything
    else was changed since."""
    def git(*words):
        return subprocess.run(["git", *words, "--", ".", ":(exclude)*.md"], cwd=root, check=True,
                              capture_output=True, text=True).stdout.strip()
    commit = git("log", "-1", "--format=%h")
    return f"{commit}-changed" if git("status", "--porcelain") else commit


class Commands:
    """Runs one command after the other. SIGINT and SIGTERM end the one that runs, and its children,
    and keep others from being run; the second such signal kills it."""

    def __init__(self):
        self._is_stopped = False
        self._process = None

    def stop_on_signals(self):
        signal.signal(signal.SIGINT, self._stop)
        signal.signal(signal.SIGTERM, self._stop)

    def _stop(self, *_):
        self._end(signal.SIGKILL if self._is_stopped else signal.SIGTERM)
        self._is_stopped = True

    def _end(self, how):
        if self._process and self._process.returncode is None:
            os.killpg(self._process.pid, how)

    def run(self, command):
        """The exit status. Raises Stopped where a signal came, before or while it ran."""
        if not self._is_stopped:
            self._process = subprocess.Popen(command, start_new_session=True)
            if self._is_stopped:  # just as it began
                self._end(signal.SIGTERM)
            result = self._process.wait()
        if self._is_stopped:
            raise Stopped
        return result


def covered(part, record):
    """In words, as far as the steps can be known without preparing anything."""
    passed = record.passed(part)
    if not passed:
        return "not run"
    return f"{len(passed)} steps passed, {sum(passed.values()) / 60:.0f} min"


def run(part, record, commands, say=print):
    """Whether all steps of the part have passed by now. A step that fails ends the part."""
    for step in part.prepare:
        say(f"{part.name}: {step.name}")
        if commands.run(step.command) != 0:
            say(f"{part.name}: {step.name} FAILED")
            return False
    steps = part.steps()
    total = sum(step.covers for step in steps)

    def so_far():
        done = sum(step.covers for step in steps if step.name in record.passed(part))
        return f"{part.name}: {done} of {total} {part.unit}"

    say(f"{so_far()} covered before")
    for step in steps:
        if step.name in record.passed(part):
            continue
        begun = time.monotonic()
        try:
            result = commands.run(step.command)
        except Stopped:
            say(f"{so_far()} covered; stopped in {step.name}")
            raise
        if result != 0:
            say(f"{so_far()} covered; {step.name} FAILED: {' '.join(map(str, step.command))}")
            return False
        record.add(part, step.name, time.monotonic() - begun)
        say(so_far())
    return True
