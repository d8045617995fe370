# SPDX-License-Identifier: Apache-2.0
"""What a program says to --help, taken apart: the form is that of CLI11, the words are free."""

import re
import subprocess
from collections import Counter
from dataclasses import dataclass, field

HEADING = re.compile(r"(\S.*):$")
NAMES = re.compile(r"-[\w.-]+(?:, ?-[\w.-]+)*")
WORD = r"[\w.+-]+"
LISTED = re.compile(rf": ((?:{WORD}, )*{WORD} or {WORD})(?=$| \()")
# Notes that may follow the names of an option in place of its value.
NOTE = re.compile(r"(Excludes|Needs|REQUIRED|\(Env):?")
VALUE = re.compile(r"(-|\{|\[|in \[|[A-Z]+(\.\.\.)?$)")


@dataclass
class Entry:
    """An option, an argument or a command."""

    head: str  # as written: "-q, --quiet", "--stream NAME", "colour..."
    lines: list = field(default_factory=list)

    @property
    def names(self):
        match = NAMES.match(self.head)
        return re.split(", ?", match[0]) if match else []

    @property
    def value(self):
        """The name of the value that the option takes, or nothing."""
        match = NAMES.match(self.head)
        after = self.head[match.end():].strip() if match else ""
        return "" if NOTE.match(after) else after

    @property
    def choices(self):
        """The accepted values, where the help lists them: as a|b or {a,b} in place of a value, as
        "...: a, b or c" at the end of the text, or as a table below it."""
        if not self.value:
            return []
        if named := re.fullmatch(rf"({WORD})(\|{WORD})+", self.value):
            words = named[0].split("|")
            return [] if any(word.isupper() for word in words) else words  # FILE|JSON names none
        if braced := re.search(r"\{([^{}]+)\}", self.value):
            return braced[1].split(",")
        if told := LISTED.search(" ".join(self.lines)):
            return re.split(", | or ", told[1])
        return self._first_column()

    def _first_column(self):
        """The words that begin the rows of a table. A row may have its text on the next line."""
        rows = []
        for line, following in zip(self.lines[1:], self.lines[2:] + [""]):
            row = re.match(rf"({WORD}(?:, {WORD})*)( {{2,}}\S|$)", line)
            if row and (row[2] or following.startswith("  ")):
                rows.append(row[1])
        return [word for row in rows for word in row.split(", ")] if len(rows) > 1 else []

    @property
    def summary(self):
        return " ".join(self.lines[:1])


@dataclass
class Section:
    heading: str
    entries: list = field(default_factory=list)
    verbatim: list = field(default_factory=list)  # lines of examples, in place of entries


@dataclass
class HelpPage:
    words: list  # ["viewloom", "publish"]
    description: list = field(default_factory=list)
    usage: str = ""
    sections: list = field(default_factory=list)
    remarks: list = field(default_factory=list)

    @property
    def options(self):
        return [entry for section in self.sections for entry in section.entries if entry.names]

    @property
    def commands(self):
        return [entry for section in self.sections for entry in section.entries
                if section.heading.lower() in ("commands", "subcommands")]


def _text_column(lines):
    """Where descriptions begin: most entries are shorter, and padded to there."""
    starts = Counter(match.end() for line in lines
                     if (match := re.match(r"  \S.*? {2,}(?=\S)", line)))
    return starts.most_common(1)[0][0] if starts else 0


def _entry(line, column):
    head, text = line[:column].strip(), line[column:]
    is_padded = len(line) > column and line[column - 1] == " "
    is_head_alone = head.endswith(",") or (line[column - 2:column - 1] != " " and VALUE.match(text))
    if is_padded and not is_head_alone:
        return Entry(head, [text])
    return Entry(line.strip())


def parse(words, text):
    page, section = HelpPage(words), None
    lines = text.splitlines()
    column = _text_column(lines)
    for line, following in zip(lines, lines[1:] + [""]):
        heading = HEADING.match(line)
        if heading and re.match(r" {2}\S", following):
            section = Section(heading[1])
            page.sections.append(section)
        elif line.startswith("Usage: "):
            page.usage = line.removeprefix("Usage: ")
        elif re.match(r"\S", line):
            (page.remarks if page.usage else page.description).append(line)
        elif section is None or not line.strip():
            continue
        elif section.verbatim or line.startswith("  " + words[0]) and not section.entries:
            section.verbatim.append(line)
        elif re.match(r" {2}\S", line):
            section.entries.append(_entry(line, column))
        elif section.entries:
            section.entries[-1].lines.append(line[column:] or line.strip())
    return page


def _said(command):
    return subprocess.run([*command, "--help"], check=True, capture_output=True, text=True).stdout


def read_pages(program, name):
    """The page of the program, then those of its commands."""
    first = parse([name], _said([program]))
    return [first] + [parse([name, entry.head], _said([program, entry.head]))
                      for entry in first.commands]
