# SPDX-License-Identifier: Apache-2.0
"""Plain English: how comments begin, and how long the sentences of documents are."""

import os
import re

from tree import Finding, VENDORED

SENTENCE_WORDS_MAX = 30
# A clause instead of a thing: the reader would have to guess what the comment is about.
CLAUSE = re.compile(r"(Of|Who|Whose|What|That|As)\b")
SLASHES = (".cpp", ".h", ".comp", ".vert", ".frag", ".glsl", ".proto", ".js")
HASHES = (".py", ".sh", ".cmake", ".toml")
HASH_NAMES = ("CMakeLists.txt", "Containerfile")
# Behind code. Two blanks before a hash: one may be a part of a word of the shell.
BEHIND_SLASHES = re.compile(r"[;,{}()\w]\s+// (.*)$")
BEHIND_HASH = re.compile(r"\S  # (.*)$")
SENTENCE_END = re.compile(r"(?<=[.:;?!])\s+")
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
LIST_ITEM = re.compile(r"\s*([-*]|\d+\.) ")


def _mark(path):
    if path.endswith(SLASHES):
        return "//"
    if path.endswith(HASHES) or os.path.basename(path) in HASH_NAMES:
        return "#"
    return None


def _beginnings(lines, mark):
    """(line, text) of the first line of each comment."""
    behind_code = BEHIND_SLASHES if mark == "//" else BEHIND_HASH
    was_comment = False
    for number, line in enumerate(lines, 1):
        text = line.strip()
        is_comment = text.startswith(mark)
        if is_comment and not was_comment:
            yield number, text[len(mark):].strip()
        elif not is_comment and (match := behind_code.search(line)):
            yield number, match.group(1)
        # An empty line of a comment ends a paragraph, the licence a head of its own.
        was_comment = is_comment and text != mark and "SPDX-License-Identifier" not in text


def check_comments(tree):
    for path in tree.text_files():
        mark = _mark(path)
        if mark is None or path.startswith(VENDORED):
            continue
        for number, text in _beginnings(tree.lines(path), mark):
            if match := CLAUSE.match(text):
                yield Finding(path, number, "comment",
                              f"begins with \"{match.group(1)}\": name the thing or the act first")


def _paragraphs(lines):
    """(line, text) of what is prose: no code, no tables, no headings."""
    first, words, is_code = 0, [], False
    for number, line in enumerate([*lines, ""], 1):
        is_fence = line.strip().startswith(("```", "~~~"))
        is_item = LIST_ITEM.match(line)
        is_indented_code = line.startswith("    ") and not words
        is_prose = not (is_code or is_fence or is_indented_code or not line.strip()
                        or line.lstrip().startswith(("#", "|")))
        if words and (is_item or not is_prose):
            yield first, " ".join(words)
            words = []
        is_code ^= is_fence
        if is_prose:
            first = first if words else number
            words.append(line.strip())


def check_sentences(tree):
    for path in tree.text_files(".md"):
        for number, text in _paragraphs(tree.lines(path)):
            for sentence in SENTENCE_END.split(LINK.sub(r"\1", text)):
                count = len(sentence.split())
                if count > SENTENCE_WORDS_MAX:
                    yield Finding(path, number, "sentence",
                                  f"{count} words, at most {SENTENCE_WORDS_MAX}: "
                                  f"\"{' '.join(sentence.split()[:6])} ...\"")


def check(tree):
    yield from check_comments(tree)
    yield from check_sentences(tree)
