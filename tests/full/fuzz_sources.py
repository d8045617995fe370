# SPDX-License-Identifier: Apache-2.0
"""What each fuzz target is built from. Follows includes, so that it needs no build.

A header stands for its source as well: x.h for x.cpp, and for those sources of its folder that
include it and have no header of their own. Libraries of the system do not count.
"""

import hashlib
import json
import pathlib
import re

# Folders of includes, in the order of the compiler; messages are made from proto/.
ROOTS = ("tests", "server/core", "server/engine/walk", "server/engine", "server", "client",
         "shaders", "proto")
INCLUDE = re.compile(r'^\s*(?:#\s*include|import)\s+"([^"]+)"', re.MULTILINE)
TARGET = re.compile(r'^ +FuzzTarget\{"([a-z0-9_]+)", (\w+),', re.MULTILINE)
# Names all targets, and is no part of any.
LIST = "tests/fuzz/targets.h"
# Literals are kept as they are; what is between them loses its comments and its layout.
LITERAL_OR_COMMENT = re.compile(r'''R"(\w*)\(.*?\)\1" | "(?:\\.|[^"\\\n])*" | \b\d(?:'?\w)*
                                  | '(?:\\.|[^'\\\n])+' | //[^\n]* | /\*.*?\*/''',
                                re.DOTALL | re.VERBOSE)


def without_comments(text):
    """The text as a compiler sees it: neither comments nor line breaks make a difference."""
    parts, end = [], 0
    for match in LITERAL_OR_COMMENT.finditer(text):
        parts.append(" ".join(text[end:match.start()].split()))
        if not match.group().startswith("/"):
            parts.append(match.group())
        end = match.end()
    parts.append(" ".join(text[end:].split()))
    return "\n".join(part for part in parts if part)


class FuzzSources:
    """The targets of a tree, and their sources. Paths are relative to its root."""

    def __init__(self, root):
        self._root = pathlib.Path(root)
        listed = self._text("tests/fuzz/fuzz_targets.cpp")
        self._functions = dict(TARGET.findall(listed))
        self._texts, self._parts, self._alone = {}, {}, {}

    def targets(self):
        return sorted(self._functions)

    def file_of(self, target):
        """The source that defines the target."""
        begin = re.compile(rf"^bool {self._functions[target]}\(", re.MULTILINE)
        for path in sorted(self._root.glob("tests/fuzz/*.cpp")):
            if begin.search(path.read_text()):
                return str(path.relative_to(self._root))
        raise FileNotFoundError(f"no source of tests/fuzz defines the target {target}")

    def files_of(self, target):
        """All sources and headers that the target is built from, sorted."""
        found, open_ends = set(), [self.file_of(target)]
        while open_ends:
            path = open_ends.pop()
            if path not in found:
                found.add(path)
                open_ends += self._parts_of(path)
        return sorted(found)

    def state_of(self, target):
        """Names what the target is built from, and how: another name, another program."""
        digest = hashlib.sha256()
        presets = json.loads(self._text("CMakePresets.json"))["configurePresets"]
        options = next(preset for preset in presets if preset["name"] == "fuzz")
        digest.update(json.dumps(options["cacheVariables"], sort_keys=True).encode())
        for path in self.files_of(target):
            digest.update(f"\0{path}\0{without_comments(self._text_of(path))}".encode())
        return digest.hexdigest()[:12]

    def _text(self, path):
        return (self._root / path).read_text()

    def _text_of(self, path):
        if path not in self._texts:
            self._texts[path] = self._text(path)
        return self._texts[path]

    def _parts_of(self, path):
        if path not in self._parts:
            self._parts[path] = self._included(path) + self._sources_of(path)
        return self._parts[path]

    def _included(self, path):
        found = (self._resolve(path, name) for name in INCLUDE.findall(self._text_of(path)))
        return [other for other in found if other not in (None, LIST)]

    def _resolve(self, path, name):
        """None = it belongs to a library."""
        name = re.sub(r"(\.grpc)?\.pb\.h$", ".proto", name)
        folders = [pathlib.PurePath(path).parent, *map(pathlib.PurePath, ROOTS)]
        return next((str(folder / name) for folder in folders
                     if (self._root / folder / name).is_file()), None)

    def _sources_of(self, path):
        header = self._root / path
        if header.suffix != ".h":
            return []
        own = [header.with_suffix(".cpp")] if header.with_suffix(".cpp").exists() else []
        return [str(source.relative_to(self._root)) for source in own] + [
            source for source in self._without_header(pathlib.PurePath(path).parent)
            if path in self._included(source)]

    def _without_header(self, folder):
        """Sources of a folder that have no header of their own. Those of targets are none."""
        if folder not in self._alone:
            self._alone[folder] = [
                str(source.relative_to(self._root))
                for source in sorted((self._root / folder).glob("*.cpp"))
                if not source.with_suffix(".h").exists() and not source.stem.endswith("_test")
                and str(folder) != "tests/fuzz"]
        return self._alone[folder]
