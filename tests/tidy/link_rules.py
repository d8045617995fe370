# SPDX-License-Identifier: Apache-2.0
"""Links of documents lead to files of the tree, and to headings that are there."""

import os
import re

from tree import Finding

MARKDOWN_LINK = re.compile(r"\]\(([^)\s]+)\)|<img[^>]*src=\"([^\"]+)\"")
HEADING = re.compile(r"#+ +(.*?)\s*$")
LINKED_TEXT = re.compile(r"\[([^\]]*)\]\([^)]*\)")


def _links(tree, path):
    """(line, target as written, file relative to the root, heading or "") of each link."""
    for number, line in enumerate(tree.lines(path), 1):
        for match in MARKDOWN_LINK.finditer(line):
            written = match.group(1) or match.group(2)
            target, _, heading = written.partition("#")
            if not re.match(r"[a-z]+:", written):
                joined = os.path.normpath(os.path.join(os.path.dirname(path), target))
                yield number, written, joined if target else path, heading


def linked_files(tree):
    """What the documents link to or show, relative to the root."""
    return {full for path in tree.text_files(".md") for _, _, full, _ in _links(tree, path)}


def headings(lines):
    """The names by which links reach the headings of a document, as GitHub makes them."""
    found, is_code = set(), False
    for line in lines:
        is_code ^= line.strip().startswith(("```", "~~~"))
        match = HEADING.match(line)
        if match and not is_code:
            words = re.sub(r"[^\w\- ]", "", LINKED_TEXT.sub(r"\1", match.group(1)).lower())
            name, count = words.replace(" ", "-"), 0
            while name + (f"-{count}" if count else "") in found:
                count += 1
            found.add(name + (f"-{count}" if count else ""))
    return found


def check(tree):
    names = {path: headings(tree.lines(path)) for path in tree.text_files(".md")}
    for path in names:
        for number, written, full, heading in _links(tree, path):
            if full not in tree and not tree.has_folder(full) and full != ".":
                yield Finding(path, number, "link", f"{written} is not there")
            elif heading and full in names and heading not in names[full]:
                yield Finding(path, number, "link", f"{full} has no heading #{heading}")
