# SPDX-License-Identifier: Apache-2.0
"""Reads a Containerfile: its stages, and the instructions of each."""

import json
import re
import shlex
from dataclasses import dataclass, field

# ADD is not among them: it may fetch files of anybody from the network.
KNOWN = {"FROM", "WORKDIR", "COPY", "RUN", "USER", "EXPOSE", "ENV", "HEALTHCHECK", "ENTRYPOINT",
         "CMD", "LABEL", "STOPSIGNAL"}


class Unreadable(ValueError):
    """A line that no container tool would take, or that is not checked here."""


@dataclass
class Instruction:
    """One instruction. flags: {"from": "build"} of --from=build."""

    line: int
    word: str
    text: str
    flags: dict = field(default_factory=dict)

    def words(self):
        """The arguments, whether they stand as JSON or as words."""
        if self.text.startswith("["):
            try:
                words = json.loads(self.text)
            except ValueError as problem:
                raise Unreadable(f"line {self.line}: {problem}") from None
            if not words or not all(isinstance(word, str) for word in words):
                raise Unreadable(f"line {self.line}: not a list of texts")
            return words
        try:
            return shlex.split(self.text)
        except ValueError as problem:
            raise Unreadable(f"line {self.line}: {problem}") from None

    def is_exec_form(self):
        return self.text.startswith("[")


@dataclass
class Stage:
    """What begins with FROM. name: "" where it has none."""

    image: str
    name: str
    line: int
    instructions: list = field(default_factory=list)

    def of(self, word):
        return [one for one in self.instructions if one.word == word]


def _logical_lines(text):
    """(number of the first line, text) of each instruction; continued lines are joined."""
    parts, first = [], 0
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("#") or not line.strip():
            continue
        first = first or number
        parts.append(line.rstrip().removesuffix("\\"))
        if not line.rstrip().endswith("\\"):
            yield first, "".join(parts).strip()
            parts, first = [], 0
    if parts:
        raise Unreadable(f"line {first}: the last line ends in a backslash")


def _instruction(number, line):
    word, _, rest = line.partition(" ")
    if word not in KNOWN:
        raise Unreadable(f"line {number}: {word} is not accepted; accepted is "
                         f"{', '.join(sorted(KNOWN))}")
    flags, rest = {}, rest.strip()
    while match := re.match(r"--([\w-]+)=(\S+)\s+", rest):
        flags[match.group(1)] = match.group(2)
        rest = rest[match.end():]
    if not rest:
        raise Unreadable(f"line {number}: {word} says nothing")
    return Instruction(number, word, rest, flags)


def stages_of(text):
    """The stages of a Containerfile, in order."""
    stages = []
    for number, line in _logical_lines(text):
        one = _instruction(number, line)
        if one.word == "FROM":
            match = re.fullmatch(r"(\S+)(?:\s+AS\s+([\w.-]+))?", one.text, re.IGNORECASE)
            if not match:
                raise Unreadable(f"line {number}: FROM takes IMAGE [AS NAME], not {one.text}")
            stages.append(Stage(match.group(1), match.group(2) or "", number))
        elif not stages:
            raise Unreadable(f"line {number}: {one.word} stands before the first FROM")
        else:
            stages[-1].instructions.append(one)
    if not stages:
        raise Unreadable("there is no FROM")
    return stages
