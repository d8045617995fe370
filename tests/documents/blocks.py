# SPDX-License-Identifier: Apache-2.0
"""Fenced blocks of a Markdown document, and the commands that they hold.

A block without a language, or with one of COMMANDS, holds commands. All other blocks say what they
are: a language of SNIPPETS, or one of TEXTS. A sentence right before a block may say why the tests
do not run it:

  *The tests do not run this block: it needs Docker.*
"""

import re
from typing import NamedTuple

COMMANDS = ("", "sh", "bash", "console")
SNIPPETS = ("cpp", "glsl", "http", "js", "json", "python", "toml")
TEXTS = ("cmake", "html", "nginx", "text")
FENCE = re.compile(r"^( *)(```+|~~~+) *(\w*)$")
REASON = re.compile(r"^\*The tests do not run this block: (\S.*)\.\*$")
PROMPT = "$ "
# Beginnings of commands. Output such as "viewloomd can run" has no subcommand after the program.
LOOKS_LIKE_A_COMMAND = re.compile(
    r"^(?:\$ |(?:cd|cmake|ctest|curl|docker|export|journalctl|ninja|node|npm|sudo) \S"
    r"|(?:deploy|tests|client|build)/[\w./-]+\.(?:sh|py)\b|/usr/bin/\w+ |[A-Z_]+=\S+ \S"
    r"|viewloomd? (?:-|advise|bench|cast|certificate|doctor|inspect|list|publish|record|render"
    r"|serve|show|token|watch)\b)")


class Command(NamedTuple):
    """One command with the lines of output that the document shows after it."""

    line: int
    text: str
    output: tuple


class Block(NamedTuple):
    """`line` is that of the fence; `reason` says why the block does not run, or is empty."""

    document: str
    line: int
    language: str
    lines: tuple
    reason: str

    @property
    def text(self):
        return "\n".join(self.lines)

    def holds_commands(self):
        return self.language in COMMANDS

    def commands(self):
        has_prompt = any(line.startswith(PROMPT) for line in self.lines)
        found, number = [], 0
        while number < len(self.lines):
            first, line = number, self.lines[number]
            number += 1
            if has_prompt and not line.startswith(PROMPT):
                if found:
                    found[-1].output.append(line)
                continue
            while line.endswith("\\") and number < len(self.lines):
                line += "\n" + self.lines[number]
                number += 1
            line = line.removeprefix(PROMPT) if has_prompt else line
            if line.strip() and not line.lstrip().startswith("#"):
                found.append(Command(self.line + 1 + first, line.strip(), []))
        return [command._replace(output=tuple(command.output)) for command in found]


def read_blocks(document, text):
    """All fenced blocks of a document, in order."""
    lines = text.splitlines()
    found, number = [], 0
    while number < len(lines):
        fence = FENCE.match(lines[number])
        number += 1
        if not fence:
            continue
        first, indent = number, len(fence[1])
        while number < len(lines) and lines[number].strip() != fence[2]:
            number += 1
        before = [line for line in lines[:first - 1] if line.strip()]
        reason = REASON.match(before[-1]) if before else None
        found.append(Block(document, first, fence[3],
                           tuple(line[indent:] for line in lines[first:number]),
                           reason[1] if reason else ""))
        number += 1
    return found


def wrong_languages(blocks):
    """Blocks that do not say what they are, or hold commands that nobody runs, as sentences."""
    for block in blocks:
        place = f"{block.document}:{block.line}"
        if block.language not in COMMANDS + SNIPPETS + TEXTS:
            yield f"{place}: the tests know no language \"{block.language}\""
        elif block.language in TEXTS:
            for line in block.lines:
                if LOOKS_LIKE_A_COMMAND.match(line):
                    yield (f"{place}: \"{line}\" is a command in a block of \"{block.language}\": "
                           "leave the language out, so that it runs")


def code_spans(text):
    """(line, text) of `code` in prose and tables, outside of the blocks."""
    fenced = ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence or (fenced and line.strip() == fenced):
            fenced = "" if fenced else fence[2]
        elif not fenced:
            for span in re.findall(r"(?<!`)`([^`]+)`", line):
                yield number, span
