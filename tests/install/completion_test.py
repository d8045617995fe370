# SPDX-License-Identifier: Apache-2.0
"""The installed completions complete commands, options and values in a real bash and zsh."""

import os
import pty
import select
import shutil
import subprocess
import time
import unittest

import installed_tree
from installed_tree import ENVIRONMENT, PREFIX, SCRATCH

END = "end-of-words"
# The program is a function that prints its words. So a completed line shows what it became.
SHOW_WORDS = f"() {{ printf '<%s>' \"$@\"; printf '\\n{END[:3]}''%s\\n' '{END[3:]}'; }}"


class Shell:
    """An interactive shell at a terminal."""

    def __init__(self, *command):
        self._terminal, terminal = pty.openpty()
        self._process = subprocess.Popen(command, stdin=terminal, stdout=terminal, stderr=terminal,
                                         env={**ENVIRONMENT, "TERM": "dumb", "PS1": "$ "},
                                         cwd=SCRATCH, start_new_session=True)
        os.close(terminal)

    def type(self, keys, until):
        """What the shell shows, up to the text that is waited for."""
        os.write(self._terminal, keys.encode())
        shown, deadline = "", time.monotonic() + installed_tree.PATIENCE_S
        while until not in shown:
            if not select.select([self._terminal], [], [], deadline - time.monotonic())[0]:
                raise AssertionError(f"{keys!r}: {until!r} is not in {shown!r}")
            shown += os.read(self._terminal, 4096).decode(errors="replace")
        return shown

    def words(self, keys):
        """The words of a line, completed with Tab."""
        return self.type(keys + "\n", END)

    def close(self):
        self._process.kill()
        self._process.wait()
        os.close(self._terminal)


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        installed_tree.install()
        (SCRATCH / "picture.exr").touch()

    def completes(self, shell, line, words):
        self.assertIn("".join(f"<{word}>" for word in words), shell.words(line), line)

    def check(self, shell):
        self.addCleanup(shell.close)
        for program in ("viewloom", "viewloomd"):
            shell.type(program + SHOW_WORDS + f"; echo {program}''-is-set\n", f"{program}-is-set")
        self.completes(shell, "viewloom pub\t", ["publish"])
        self.completes(shell, "viewloom publish --synth\t", ["publish", "--synthetic"])
        self.completes(shell, "viewloom publish pict\t", ["publish", "picture.exr"])
        self.completes(shell, "viewloom publish --input blen\t", ["publish", "--input", "blender"])
        self.completes(shell, "viewloom list --serv\tHOST", ["list", "--server", "HOST"])
        self.completes(shell, "viewloomd doc\t", ["doctor"])
        self.completes(shell, "viewloomd --grpc.ad\t", ["--grpc.address"])

    def test_bash(self):
        shell = Shell("bash", "--norc", "--noprofile", "-i")
        for program in ("viewloom", "viewloomd"):
            script = PREFIX / "share/bash-completion/completions" / program
            shell.type(f". {script} && echo {program}''-loaded\n", f"{program}-loaded")
        self.check(shell)

    def test_zsh(self):
        zsh = shutil.which("zsh")
        if zsh is None:
            self.skipTest("there is no zsh")
        shell = Shell(zsh, "-f", "-i")
        folder = PREFIX / "share/zsh/site-functions"
        shell.type(f"unsetopt zle_bracketed_paste; fpath=({folder} $fpath); autoload -U compinit; "
                   "compinit -D -u && echo com''pinit-done\n", "compinit-done")
        self.check(shell)


if __name__ == "__main__":
    unittest.main()
