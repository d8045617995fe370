# SPDX-License-Identifier: Apache-2.0
"""Rules on the text of every file: licence line, lengths, words, names, machine paths."""

import ast
import os
import re

from tree import Finding, VENDORED

SHADERS = (".comp", ".vert", ".frag", ".glsl")
SOURCES = SHADERS + (".cpp", ".h", ".proto", ".py", ".js", ".css", ".html", ".sh", ".cmake",
                     ".toml", ".service", ".yml", ".yaml")
SOURCE_NAMES = ("CMakeLists.txt", "Containerfile", ".clang-tidy")
MEASURED = SHADERS + (".cpp", ".h", ".proto", ".py", ".js")

LINES_MAX = 300
COLUMNS_MAX = 100
FUNCTION_LINES_MAX = 60
MAIN_LINES_MAX = 60
# Path: why it may be longer.
LONG_FILES = {}
LONG_FUNCTIONS = {
    "shaders/lib/walk/walk.glsl": "two nested loops over one state of some twenty variables: as "
                             "functions they would hand all of it in and out",
}

# Alone in its line: other text beside it was joined to it by mistake.
LICENCE = re.compile(r"SPDX-License-Identifier: Apache-2\.0\s*(-->|\*/)?\s*$")
# Written in halves, so that this list does not find itself.
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|HA" r"CK|X" r"XX)\b")
# Words that tell how the project was made instead of what it is.
MAKING = re.compile(r"\b((the|an?|our|this|earlier)\s+proto" r"types?\b(?! of)"
                    r"|issue #?\d+|issue tra" r"cker|co-auth" r"ored-by)\b", re.IGNORECASE)
MACHINE_PATH = re.compile(r"(?<![\w.:/-])/(work|home/\w+|Users|root)/")
VAGUE = r"(Manager|Helper|Utils?|Utilities)"
VAGUE_TYPE = re.compile(r"\b(?:class|struct|enum|concept|namespace|message|service)\s+"
                        r"(?:class\s+)?(\w*?" + VAGUE + r"|util|utils|helpers?)\b(?!\s*::)")
VAGUE_FILE = re.compile(r"(^|[_-])(manager|helpers?|utils?|misc|common)([_.-]|$)")

CONTROL = re.compile(r"\s*(\}\s*)?(namespace|class|struct|enum|union|extern|if|else|for|while"
                     r"|switch|do|try|catch|return|message|service|layout|case|default)\b")
LAMBDA = re.compile(r"\[[^\]]*\]\s*[({]")


def is_source(path):
    return (path.endswith(SOURCES) or os.path.basename(path) in SOURCE_NAMES
            or path == ".ci/run")


def check_licence(tree):
    for path in tree.text_files():
        head = tree.lines(path)[:3]
        if is_source(path) and not any(LICENCE.search(line) for line in head):
            yield Finding(path, 1, "licence",
                          "a line with only SPDX-License-Identifier: Apache-2.0 is missing")


def check_lengths(tree):
    for path in tree.text_files(*MEASURED):
        lines = tree.lines(path)
        limit = MAIN_LINES_MAX if os.path.basename(path) == "main.cpp" else LINES_MAX
        if len(lines) > limit and path not in LONG_FILES:
            yield Finding(path, len(lines), "length", f"{len(lines)} lines, at most {limit}")
        for number, line in enumerate(lines, 1):
            if len(line) > COLUMNS_MAX:
                yield Finding(path, number, "columns",
                              f"{len(line)} columns, at most {COLUMNS_MAX}")
    for path in LONG_FILES:
        if path in tree and len(tree.lines(path)) <= LINES_MAX:
            yield Finding(path, 0, "length", "is short enough now: take it out of LONG_FILES")


def _braced_functions(lines):
    """(line, length) of what opens with `) ... {` and closes at the same indentation."""
    for start, line in enumerate(lines):
        if not line.rstrip().endswith("{") or ")" not in line or CONTROL.match(line) or \
                LAMBDA.search(line):
            continue
        # A signature over several lines starts at the last line that is less indented.
        first = start
        while first > 0 and lines[first].startswith("    ") and lines[first - 1].strip() and \
                not lines[first - 1].rstrip().endswith((";", "{", "}")):
            first -= 1
        indent = len(lines[first]) - len(lines[first].lstrip())
        if indent > 2 or CONTROL.match(lines[first]):
            continue
        closing = re.compile(" " * indent + r"\}")
        for end in range(start + 1, len(lines)):
            if closing.match(lines[end]):
                yield first + 1, end - first + 1
                break


def _python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1


def check_functions(tree):
    for path in tree.text_files(".cpp", ".h", ".js", ".py", *SHADERS):
        lines = tree.lines(path)
        found = _python_functions("\n".join(lines)) if path.endswith(".py") \
            else _braced_functions(lines)
        for line, length in found:
            if length > FUNCTION_LINES_MAX and path not in LONG_FUNCTIONS:
                yield Finding(path, line, "function",
                              f"{length} lines, at most {FUNCTION_LINES_MAX}")


def check_words(tree):
    for path in tree.text_files():
        for number, line in enumerate(tree.lines(path), 1):
            for rule, pattern in (("unfinished", UNFINISHED), ("making", MAKING),
                                  ("machine path", MACHINE_PATH)):
                match = pattern.search(line)
                if match:
                    yield Finding(path, number, rule, f"\"{match.group(0)}\"")


def check_names(tree):
    for path in tree.paths():
        if path.startswith(VENDORED):
            continue
        name = os.path.basename(path)
        if VAGUE_FILE.search(name):
            yield Finding(path, 0, "name", "says nothing: name what the file is about")
        stem_is_free = name.endswith((".md", ".txt")) or name.startswith((".", "Container"))
        if is_source(path) and not stem_is_free and not re.fullmatch(r"[a-z0-9_.-]+|\w+\.cmake",
                                                                     name):
            yield Finding(path, 0, "name", "files are snake_case")
    for path in tree.text_files(*MEASURED):
        for number, line in enumerate(tree.lines(path), 1):
            match = VAGUE_TYPE.search(line.split("//")[0])
            if match:
                yield Finding(path, number, "name", f"\"{match.group(1)}\" names no idea")


def check(tree):
    for rule in (check_licence, check_lengths, check_functions, check_words, check_names):
        yield from rule(tree)
