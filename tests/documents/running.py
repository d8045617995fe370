# SPDX-License-Identifier: Apache-2.0
"""Commands under bash, each with its own process group, so that nothing of it stays."""

import os
import pathlib
import shlex
import signal
import subprocess
import tempfile
import time

ENDED_BY_CTRL_C = (0, 130, -signal.SIGINT)
TAIL_LINES = 25
STEP_S = 0.05
# Variables of the shell itself, which the next command's shell has from somewhere else.
TAKING_STATE = r"""
set -e; __state={state}; . "$__state/exports"; cd "$(cat "$__state/folder")"
"""
LEAVING_STATE = r"""
trap 'export -p | grep -vE " (DISPLAY|OLDPWD|SHLVL)=" >"$__state/exports"
      pwd >"$__state/folder"' EXIT
"""


class Failure(Exception):
    """A command that did not do what its document says. `command` and `said` are empty where the
    fault is not that of a command."""

    def __init__(self, what, command="", said=""):
        super().__init__(what)
        self.command, self.said = command, said


def tail(text):
    return "\n".join("    " + line for line in text.splitlines()[-TAIL_LINES:])


class Running:
    """One command. It starts with the folder and the exports that the last one left."""

    def __init__(self, text, workplace, leaves_state=False, **environment):
        self.text = text
        self._last_words = ""
        self._said = tempfile.TemporaryFile("w+", errors="replace")
        script = TAKING_STATE.format(state=shlex.quote(str(workplace.state)))
        if leaves_state:
            script += LEAVING_STATE
        self.process = subprocess.Popen(
            ["bash", "-c", script + text], cwd=workplace.root, stdin=subprocess.DEVNULL,
            stdout=self._said, stderr=subprocess.STDOUT, start_new_session=True,
            env=workplace.environment(**environment))

    def said(self):
        if self._said.closed:
            return self._last_words
        self._said.seek(0)
        return self._said.read()

    def fail(self, what):
        said = self.said()
        raise Failure(f"{what}\n  $ {self.text}\n{tail(said)}", self.text, said)

    def wait(self, patience_s):
        """For a command that ends by itself, with 0."""
        try:
            code = self.process.wait(patience_s)
        except subprocess.TimeoutExpired:
            self.fail(f"did not end within {patience_s} s")
        if code != 0:
            self.fail(f"ended with exit code {code}")

    def wait_for(self, is_ready, what, patience_s):
        """For a command without an end."""
        deadline = time.monotonic() + patience_s
        while not is_ready():
            if self.process.poll() is not None:
                self.fail(f"ended with exit code {self.process.returncode}, without {what}")
            if time.monotonic() > deadline:
                self.fail(f"waited {patience_s} s for {what}")
            time.sleep(STEP_S)

    def _signal(self, number):
        try:
            os.killpg(self.process.pid, number)
            return True
        except ProcessLookupError:
            return False

    def stop(self, patience_s):
        """Ctrl-C. It fails if the command then ends in another way than in order."""
        if self.process.poll() is None:
            self._signal(signal.SIGINT)
        try:
            code = self.process.wait(patience_s)
        except subprocess.TimeoutExpired:
            self.fail(f"did not end within {patience_s} s after Ctrl-C")
        finally:
            self.kill()
        if code not in ENDED_BY_CTRL_C:
            self.fail(f"ended with exit code {code} after Ctrl-C")

    def kill(self):
        """Also what the command left in the background."""
        self._signal(signal.SIGKILL)
        self.process.wait()
        self._last_words = self.said()
        self._said.close()


def cpu_seconds():
    """CPU time of all commands that have ended."""
    times = os.times()
    return times.children_user + times.children_system


def file_names(folder):
    return set(pathlib.Path(folder).rglob("*")) if pathlib.Path(folder).is_dir() else set()
