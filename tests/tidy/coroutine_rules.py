# SPDX-License-Identifier: Apache-2.0
"""No conditional expression within co_await: GCC 12 copies such a temporary bit by bit into the
frame of the coroutine, and frees it there. A string then ends the process."""

import re

from tree import Finding

CO_AWAIT = re.compile(r"\bco_await\b[^;{}]*;")
LITERAL = re.compile(r"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|//[^\n]*")


def _without_literals(text):
    """The same text with blanks in place of literals and comments."""
    return LITERAL.sub(lambda match: " " * len(match.group()), text)


def check(tree):
    for path in tree.text_files(".cpp", ".h"):
        text = _without_literals("\n".join(tree.lines(path)))
        for match in CO_AWAIT.finditer(text):
            if "?" in match.group():
                yield Finding(path, text.count("\n", 0, match.start()) + 1, "coroutine",
                              "? : within co_await; give the value a name before")
