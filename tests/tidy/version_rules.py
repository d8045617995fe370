# SPDX-License-Identifier: Apache-2.0
"""The version of viewloom stands in the top CMakeLists.txt; CHANGELOG.md alone repeats it.

All else takes it from there when it is configured, such as pyproject.toml and package.json.
"""

import json
import re

from tree import Finding

DEFINED_IN = "CMakeLists.txt"
CHANGES = "CHANGELOG.md"
PROJECT = re.compile(r"project\(viewloom VERSION (\d+\.\d+\.\d+)\b")
HEADING = re.compile(r"## \[?([^\s\]]+)")
NUMBER = re.compile(r"(?<![\d.])(\d+\.\d+\.\d+)(?!\d|\.\d)")
# A literal of any version, where the file describes a package of ours.
ASSIGNED = re.compile(r"^\s*\"?version\"?\s*[:=]\s*[\"']\d", re.IGNORECASE)
DESCRIPTIONS = (".toml", ".toml.in", ".cfg", "package.json", "package.json.in")


def _versions_told(tree):
    """(line, version) of each section of the changes, but for what is unreleased and unnamed."""
    for number, line in enumerate(tree.lines(CHANGES), 1):
        match = HEADING.match(line)
        if match and match.group(1).lower() != "unreleased":
            yield number, match.group(1)


def check_changes(version, told):
    if not told:
        yield Finding(CHANGES, 0, "version", f"has no section ## {version}")
    elif told[0][1] != version:
        yield Finding(CHANGES, told[0][0], "version",
                      f"the newest section is of {told[0][1]}, {DEFINED_IN} says {version}")


def check_literals(tree, versions):
    """No file says a version that viewloom has or had, and no description says any."""
    for path in tree.text_files():
        if path in (DEFINED_IN, CHANGES) or path.endswith("package-lock.json"):
            continue
        for number, line in enumerate(tree.lines(path), 1):
            said = [match.group(1) for match in NUMBER.finditer(line)
                    if match.group(1) in versions]
            if said or (path.endswith(DESCRIPTIONS) and ASSIGNED.match(line)):
                yield Finding(path, number, "version", f"\"{said[0] if said else line.strip()}\": "
                              f"take the version from {DEFINED_IN}, or leave it out")


def check_locks(tree):
    """The lock of a package has the versions of others, and none of its own."""
    for path in tree.text_files("package-lock.json"):
        lock = json.loads(tree.bytes(path))
        if "version" in lock or "version" in lock.get("packages", {}).get("", {}):
            yield Finding(path, 0, "version", "leave out the version of the package itself")


def check(tree):
    if DEFINED_IN not in tree or CHANGES not in tree:
        return
    match = PROJECT.search("\n".join(tree.lines(DEFINED_IN)))
    if not match:
        yield Finding(DEFINED_IN, 0, "version", "project(viewloom VERSION x.y.z ...) is missing")
        return
    told = list(_versions_told(tree))
    yield from check_changes(match.group(1), told)
    yield from check_literals(tree, {match.group(1), *(version for _, version in told)})
    yield from check_locks(tree)
