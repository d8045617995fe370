# SPDX-License-Identifier: Apache-2.0
"""Access tokens of clients that are to count as different ones, though all are on one machine."""

import subprocess
import tempfile
from pathlib import Path


class Identities:
    def __init__(self, program):
        self._program = program
        self._folder = tempfile.TemporaryDirectory()
        self._file = Path(self._folder.name) / "tokens.jsonl"
        self.operator = self.add("operator", "operate")

    def add(self, name, roles="publish,watch"):
        """The token of a new identity, for all streams."""
        return subprocess.run(
            [self._program, "token", "add", name, "--role", roles, "--streams", "*",
             "--access.token_file", self._file], check=True, capture_output=True,
            text=True).stdout.strip()

    def settings(self):
        """Of a server that knows them. Add all identities before it starts."""
        return ("--access.token_file", str(self._file))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._folder.cleanup()
