# SPDX-License-Identifier: Apache-2.0
"""Compares the output of a command with the lines that its document shows. Numbers may differ."""

import json
import re

# Lines that differ from machine to machine.
VARIES = re.compile(r"^(setup: |ok +host|(ok|advice) +device|-> for speed)")
NUMBER = re.compile(r"\d+(?:\\?\.\d+)?")


def _pattern(line):
    """`...` stands for anything, and a number for any number. Spaces count as one."""
    parts = [NUMBER.sub(r"\\d+(?:\\.\\d+)?", re.escape(part.strip()).replace(r"\ ", " "))
             for part in line.split("...")]
    return re.compile(".*".join(parts))


def _keys(value):
    """A JSON value without its leaves."""
    if isinstance(value, dict):
        return {name: _keys(entry) for name, entry in value.items()}
    return [_keys(value[0])] if isinstance(value, list) and value else None


def _json(text):
    try:
        return json.loads(text)
    except ValueError:
        return None


def missing_line(expected, said):
    """The first shown line that was not said, or None. Lines come in order, others between them."""
    shown = _json("".join(expected))
    if shown is not None:
        found = next((value for value in map(_json, [said, *said.splitlines()])
                      if value is not None), None)
        return None if _keys(found) == _keys(shown) else "".join(expected)
    lines = [" ".join(line.split()) for line in said.splitlines()]
    for line in expected:
        words = " ".join(line.split())
        if not words.strip(". ") or VARIES.match(words):
            continue
        pattern = _pattern(words)
        while lines and not pattern.search(lines[0]):
            lines.pop(0)
        if not lines:
            return line
        lines.pop(0)
    return None
