# SPDX-License-Identifier: Apache-2.0
"""A page of help as a man page, in roff."""

import re

TABLE = re.compile(r" |.*\S {2,}\S")  # lines that are in columns


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def _described(lines):
    """Text is filled. Lines in columns stay as they are."""
    was_table = False
    for line in lines:
        is_table = bool(TABLE.match(line))
        if is_table != was_table:
            yield ".nf" if is_table else ".fi"
        was_table = is_table
        yield escaped(line)
    if was_table:
        yield ".fi"


def _entry(entry):
    names, value = ", ".join(entry.names), entry.value
    yield ".TP"
    if names:
        yield f"\\fB{escaped(names)}\\fR" + (f" \\fI{escaped(value)}\\fR" if value else "")
    else:
        yield f"\\fB{escaped(entry.head)}\\fR"
    yield from _described(entry.lines)


def _section(section):
    yield f".SH {escaped(section.heading).upper()}"
    if section.verbatim:
        yield ".nf"
        yield from (escaped(line) for line in section.verbatim)
        yield ".fi"
    for entry in section.entries:
        yield from _entry(entry)


def _see_also(pages, page, section):
    others = pages[1:] if page is pages[0] else pages[:1]
    yield ".SH SEE ALSO"
    for other in others:
        end = "" if other is others[-1] else ","
        yield f".BR {escaped('-'.join(other.words))} ({section}){end}"


def written(page, pages, section, version):
    """The page, one of `pages`, which begin with that of the program."""
    name = "-".join(page.words)
    program = page.words[0]
    manual = "System Administration" if section == "8" else "User Commands"
    summary = re.sub(r"\.$", "", re.split(r"(?<=\.) ", " ".join(page.description))[0])
    lines = [f'.TH {escaped(name).upper()} {section} "" "{program} {version}" "{manual}"',
             ".ad l", ".nh", ".SH NAME", f"{escaped(name)} \\- {escaped(summary)}",
             ".SH SYNOPSIS", f"\\fB{escaped(page.usage)}\\fR",
             ".SH DESCRIPTION", *map(escaped, page.description)]
    for part in page.sections:
        lines += _section(part)
    if page.remarks:
        lines += [".SH NOTES"]
        for remark in page.remarks:
            lines += [escaped(remark), ".br"]
        lines.pop()
    lines += _see_also(pages, page, section)
    return "\n".join(lines) + "\n"
