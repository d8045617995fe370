# SPDX-License-Identifier: Apache-2.0
"""Words of developers in the texts that users read: output, errors, help and the server's log."""

import re

from tree import Finding

# Texts of these files reach users, but for names of fields in JSON and of included files.
FOR_USERS = ("client/cli/", "client/files/", "client/inputs/", "client/inspect/", "client/lib/",
             "client/photos/", "client/recording/", "client/show/", "client/usage/",
             "server/commands/", "server/config/")
LOGGED = re.compile(r"\blog\(LogLevel::")
# Values of a setting, which stand in a list.
VALUES = "trace, debug, info"
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"')
WORDS = re.compile(
    r"\b(?:trac(?:e|es|ed|ing)|drain(?:s|ed|ing)?|mailbox(?:es)?|slots?|structs?|enums?|payload|"
    r"FrameManifest|TruthManifest|scanlineimage|deepscanline|mutex|ErrorOut\w*|null|nullptr|"
    r"protobuf|INVALID_ARGUMENT|errno|stdin|boolean)\b")


def _literals(tree, path):
    """Line by line, with the literals of a log call whose end stands further below."""
    is_for_users = path.startswith(FOR_USERS)
    is_logging = False
    for number, line in enumerate(tree.lines(path), 1):
        code = line.split("//")[0] if '"' not in line else line
        if code.lstrip().startswith(("#", "//")):
            continue
        is_logging = is_logging or bool(LOGGED.search(code))
        if is_for_users or is_logging:
            for literal in LITERAL.findall(code):
                yield number, literal
        if code.rstrip().endswith(";"):
            is_logging = False


def check(tree):
    for path in tree.text_files(".cpp", ".h"):
        if not path.startswith(("client/", "server/")):
            continue
        for number, literal in _literals(tree, path):
            # Single words are keys of JSON and names that files have.
            match = WORDS.search(literal) if " " in literal.strip() and VALUES not in literal \
                else None
            if match:
                yield Finding(path, number, "user text", f"\"{match.group(0)}\" is a word of "
                              "developers: say it in the words of users")
