# SPDX-License-Identifier: Apache-2.0
"""The files that belong to the repository, and what a check says about one of them."""

import os
import subprocess
from typing import NamedTuple

# Folders whose sources are ours to judge; google/rpc is vendored as its authors wrote it.
VENDORED = ("proto/google/",)


class Finding(NamedTuple):
    """One broken rule at one place. Line 0 means the file as a whole."""

    path: str
    line: int
    rule: str
    message: str

    def __str__(self):
        return f"{self.path}:{self.line}: [{self.rule}] {self.message}"


class Tree:
    """Paths relative to the root, with forward slashes, and their bytes."""

    def __init__(self, content_of_path):
        self._content = dict(content_of_path)

    @classmethod
    def of_repository(cls, root):
        """Tracked files and new ones that git does not ignore, as they lie on disk."""
        listed = subprocess.run(
            ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others",
             "--exclude-standard"],
            cwd=root, check=True, capture_output=True).stdout
        content = {}
        for name in listed.decode().split("\0"):
            full = os.path.join(root, name)
            if name and os.path.isfile(full):
                with open(full, "rb") as file:
                    content[name] = file.read()
        return cls(content)

    def paths(self):
        return sorted(self._content)

    def __contains__(self, path):
        return path in self._content

    def has_folder(self, path):
        return any(name.startswith(path.rstrip("/") + "/") for name in self._content)

    def bytes(self, path):
        return self._content[path]

    def is_binary(self, path):
        if b"\0" in self._content[path]:
            return True
        try:
            self._content[path].decode()
        except UnicodeDecodeError:
            return True
        return False

    def lines(self, path):
        return self._content[path].decode().splitlines()

    def text_files(self, *suffixes, vendored=False):
        """Text files with one of the suffixes (none given: all), sorted."""
        for path in self.paths():
            if suffixes and not path.endswith(suffixes):
                continue
            if not vendored and path.startswith(VENDORED):
                continue
            if not self.is_binary(path):
                yield path
