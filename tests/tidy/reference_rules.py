# SPDX-License-Identifier: Apache-2.0
"""Documents name every metric, setting and web address of the server, and no other."""

import re
from typing import NamedTuple

from tree import Finding

LABEL_VALUES = re.compile(r"\bLabelValues k\w+ = \{([^}]*)\}")
WORD = re.compile(r'"([a-z_]+)"')
NAME_IN_ROW = re.compile(r"\| `([^`]+)` \|")


class Table(NamedTuple):
    """A table of a document, and the code that defines what stands in it."""

    what: str
    document: str
    heading: str  # of the section with the table
    sources: str  # beginning of their paths
    defined: re.Pattern  # one group has the name
    name_begins: str  # in the first column of the table; others of the section begin otherwise
    name_ends: re.Pattern  # in the first column, what follows begins so
    also: tuple = ()  # documented names that no line of the code defines


TABLES = (
    Table("metric", "deploy/metrics.md", "## Metrics", "server/metrics/",
          re.compile(r'"(viewloom_[a-z_]+)"'), "viewloom_", re.compile(r"\{")),
    Table("setting", "deploy/settings.md", "## Settings", "server/config/",
          re.compile(r'\{"([a-z][a-z_.]*)",\s*"[a-z]*",\s*"[A-Z]'), "", re.compile(r"$")),
    Table("address", "proto/web.md", "## Addresses", "server/access/operations.h",
          re.compile(r'string_view k\w+ = "(/[a-z/]*)"'),
          "/", re.compile(r"STREAM|\?"), also=("/",)),
)


def _rows(tree, table):
    """(line, name) of the rows of the section."""
    is_in_section = False
    for number, line in enumerate(tree.lines(table.document), 1):
        if line.startswith("#"):
            is_in_section = line == table.heading
        elif is_in_section and (match := NAME_IN_ROW.match(line)):
            yield number, table.name_ends.split(match.group(1))[0]


def _defined(tree, table):
    """{name: (path, line)} of what the code defines."""
    found = {}
    for path in tree.text_files(".cpp", ".h"):
        if path.startswith(table.sources):
            text = "\n".join(tree.lines(path))
            for match in table.defined.finditer(text):
                found.setdefault(match.group(1), (path, text.count("\n", 0, match.start(1)) + 1))
    return found


def check_table(tree, table):
    if table.document not in tree:
        return
    told = {name: line for line, name in _rows(tree, table)}
    defined = _defined(tree, table)
    for name, (path, line) in defined.items():
        if name not in told:
            yield Finding(path, line, "reference", f"{table.what} {name} is missing in "
                          f"{table.document}, section \"{table.heading.lstrip('# ')}\"")
    for name, line in told.items():
        if name.startswith(table.name_begins) and name not in defined and name not in table.also:
            yield Finding(table.document, line, "reference",
                          f"there is no {table.what} {name} in {table.sources}")


def check_labels(tree):
    """Each value of a label of the metrics stands in the document of the metrics."""
    document = "deploy/metrics.md"
    text = "\n".join(tree.lines(document)) if document in tree else ""
    for path in tree.text_files(".cpp"):
        if not path.startswith("server/metrics/"):
            continue
        for values in LABEL_VALUES.findall("\n".join(tree.lines(path))):
            for value in WORD.findall(values):
                if f"`{value}`" not in text:
                    yield Finding(path, 0, "reference",
                                  f"{document} does not explain the label value {value}")


def check(tree):
    for table in TABLES:
        yield from check_table(tree, table)
    yield from check_labels(tree)
