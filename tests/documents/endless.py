# SPDX-License-Identifier: Apache-2.0
"""Commands that run until Ctrl-C with the sign by which each shows that it works, and the files
that others leave."""

from typing import NamedTuple


class Sign(NamedTuple):
    """`kind` is "output" (a pattern), "stream" (a name: its frames are used), "atlases" (a display
    gets some), "files" (a folder gets some), "screen" (a picture is on it) or "bridge" (it was told
    to show something).

    `role` is what only one command at a time can be. A command with a role runs until another one
    takes it, or until the end of its block: later commands need it. Others end at once."""

    kind: str
    value: str
    role: str = ""


def value_of(words, *options, default=""):
    for place, word in enumerate(words):
        if word in options:
            return words[place + 1]
        for option in options:
            if word.startswith(option + "="):
                return word[len(option) + 1:]
    return default


def _publishing(words):
    is_moving = {"--synthetic", "--pattern"} & set(words) and "--seconds" not in words
    if not is_moving and not {"--hold", "--loop", "--watch-folder"} & set(words):
        return None
    stream = value_of(words, "--stream", default="demo")
    return Sign("stream", stream, f"publisher of {stream}")


def _watching(words):
    if {"--count", "--from"} & set(words):
        return None
    folder = value_of(words, "--out")
    return Sign("files", folder) if folder else Sign("atlases", "")


def written(call):
    """Names of the files and folders that a command of viewloom leaves when it has ended."""
    if not call or call[0] != "viewloom":
        return []
    named = [value_of(call[2], option) for option in ("--out", "--picture", "--record")]
    return [name for name in named if name]


def sign_of(call, words):
    """None for a command that ends by itself. `call` is that of known_names.Programs."""
    if words[0].endswith("deploy/demo.sh"):
        return Sign("output", "Ctrl-C stops both", "server")
    if not call:
        return None
    program, subcommand, rest = call
    if program == "viewloomd":
        is_serving = subcommand in ("", "serve") and not {"--help", "--version"} & set(rest)
        return Sign("output", r"viewloomd listening grpc=\S+", "server") if is_serving else None
    if subcommand == "publish":
        return _publishing(rest)
    if subcommand == "watch":
        return _watching(rest)
    if subcommand == "show":
        return Sign("screen", "")
    if subcommand == "record" and not {"--count", "--seconds"} & set(rest):
        return Sign("atlases", "")
    if subcommand == "cast" and {"--every", "--motion"} & set(rest):
        return Sign("bridge", "")
    return None
