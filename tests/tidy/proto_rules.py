# SPDX-License-Identifier: Apache-2.0
"""Rules on our protos: the buf style, and a unit or a meaning for every number."""

import os
import re

from tree import Finding

FIELD = re.compile(r"(?:(?:repeated|optional)\s+)?([\w.]+)\s+(\w+)\s*=\s*(\d+)\s*"
                   r"(?:\[[^]]*\])?;(.*)")
NUMBERS = ("double", "float", "int32", "int64", "uint32", "uint64", "sint32", "sint64",
           "fixed32", "fixed64")
# A name that ends so says its unit; a count, a number and an index need none.
UNIT_IN_NAME = re.compile(r"(^|_)(m|px|ns|us|ms|s|hz|rad|deg|bytes|bits|db|count|number|numbers|"
                          r"index|indices|id|ids|version|columns|rows|width|height)(_(min|max))?$")


def _snake(camel):
    return re.sub(r"(?<=[a-z0-9])([A-Z])|(?<=[A-Z])([A-Z])(?=[a-z])", r"_\1\2", camel).upper()


def check_package(tree, path, text):
    folder = os.path.relpath(os.path.dirname(path), "proto").replace("/", ".")
    match = re.search(r"^package\s+([\w.]+);", text, re.MULTILINE)
    if not match or match.group(1) != folder:
        yield Finding(path, 1, "proto", f"its folder calls for \"package {folder};\"")


def check_enums(path, text):
    for match in re.finditer(r"^(\s*)enum\s+(\w+)\s*\{(.*?)^\1\}", text,
                             re.MULTILINE | re.DOTALL):
        line = text.count("\n", 0, match.start(2)) + 1
        prefix = _snake(match.group(2)) + "_"
        values = re.findall(r"^\s*(\w+)\s*=\s*(\d+)", match.group(3), re.MULTILINE)
        if (prefix + "UNSPECIFIED", "0") not in values:
            yield Finding(path, line, "proto", f"the zero value is {prefix}UNSPECIFIED")
        for name, _ in values:
            if not name.startswith(prefix):
                yield Finding(path, line, "proto", f"{name} does not start with {prefix}")


def check_services(path, text):
    for match in re.finditer(r"\bservice\s+(\w+)", text):
        if not match.group(1).endswith("Service"):
            line = text.count("\n", 0, match.start()) + 1
            yield Finding(path, line, "proto", f"service {match.group(1)} does not end in Service")
    pattern = r"\brpc\s+(\w+)\s*\((?:stream\s+)?(\w+)\)\s*returns\s*\((?:stream\s+)?(\w+)\)"
    for match in re.finditer(pattern, text):
        verb, request, response = match.groups()
        if request != verb + "Request" or response != verb + "Response":
            line = text.count("\n", 0, match.start()) + 1
            yield Finding(path, line, "proto", f"{verb} takes {verb}Request, gives {verb}Response")


def check_fields(path, lines):
    for number, line in enumerate(lines, 1):
        match = FIELD.match(line.strip())
        if not match or match.group(1) not in NUMBERS:
            continue
        _, name, _, rest = match.groups()
        described = "//" in rest or (number > 1 and lines[number - 2].strip().startswith("//"))
        if not described and not UNIT_IN_NAME.search(name):
            yield Finding(path, number, "proto unit",
                          f"{name}: say its unit and range, in the name or in a comment")


def check(tree):
    for path in tree.text_files(".proto"):
        lines = tree.lines(path)
        text = "\n".join(lines)
        yield from check_package(tree, path, text)
        yield from check_enums(path, text)
        yield from check_services(path, text)
        yield from check_fields(path, lines)
