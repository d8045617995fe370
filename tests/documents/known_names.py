# SPDX-License-Identifier: Apache-2.0
"""Options and files that a command names: which of them do not exist."""

import functools
import pathlib
import re
import shlex
import subprocess

OPERATORS = re.compile(r"^[|&;()<>]+$")
OPTION = re.compile(r"^--?[A-Za-z0-9][\w.-]*")
# One line of --help begins with all the names of an option.
HELP_LINE = re.compile(r"^ {2,4}(-{1,2}[\w.-]+(?:, ?-{1,2}[\w.-]+)*)", re.MULTILINE)
HELP_SUBCOMMAND = re.compile(r"^  ([a-z]+) {2,}", re.MULTILINE)
FOLDERS = ("client/", "deploy/", "proto/", "server/", "shaders/", "tests/", "build/release/")
PATIENCE_S = 60


def simple_commands(text):
    """The words of each command of a pipeline or list, without settings before it. Nothing of a
    text that bash cannot read either."""
    lexer = shlex.shlex(text.replace("\\\n", " "), posix=True, punctuation_chars=True)
    lexer.whitespace_split = True
    words, found = [], []
    try:
        read = [*lexer, ";"]
    except ValueError:
        return
    for word in read:
        if not OPERATORS.match(word):
            words.append(word)
        elif words:
            found.append(words)
            words = []
    for words in found:
        while words and re.match(r"^\w+=", words[0]):
            words = words[1:]
        if words:
            yield words


class Programs:
    """The subcommands and options that `viewloom --help` and `viewloomd --help` list."""

    def __init__(self, viewloomd, viewloom):
        self._paths = {"viewloomd": str(viewloomd), "viewloom": str(viewloom)}

    @functools.lru_cache(maxsize=None)
    def _help(self, program, *subcommand):
        return subprocess.run([self._paths[program], *subcommand, "--help"], check=True,
                              capture_output=True, text=True, timeout=PATIENCE_S).stdout

    def subcommands(self, program):
        listed = self._help(program).partition("Commands:\n")[2].partition("\n\n")[0]
        return set(HELP_SUBCOMMAND.findall(listed))

    def options(self, program, subcommand):
        """Those of a subcommand, and those of the program."""
        text = self._help(program)
        if subcommand:
            text += self._help(program, subcommand)
        return {name.strip() for names in HELP_LINE.findall(text) for name in names.split(",")}

    def call_of(self, words):
        """(program, subcommand, words after it) of a command that calls viewloom or viewloomd,
        also through a container. None for other commands."""
        for place, word in enumerate(words):
            name = pathlib.PurePath(word).name
            if name not in self._paths or word.startswith("-"):
                continue
            rest = words[place + 1:]
            for program in (name, *self._paths):
                subcommand = next((word for word in rest if word in self.subcommands(program)), "")
                if subcommand:
                    return program, subcommand, rest
            if place == 0:
                return name, "", rest
        return None


def unknown_options(words, programs, root):
    """Options of viewloom, viewloomd and our Python programs that these do not have."""
    call = programs.call_of(words)
    if call:
        program, subcommand, rest = call
        known = programs.options(program, subcommand)
        if not subcommand and rest and not rest[0].startswith("-"):
            yield f"{program} has no subcommand \"{rest[0]}\""
            return
        name = f"{program} {subcommand}".strip()
    else:
        scripts = [place for place, word in enumerate(words)
                   if word.endswith(".py") and (root / word).is_file()]
        if not scripts:
            return
        name, rest = words[scripts[0]], words[scripts[0] + 1:]
        known = set(re.findall(r"\"(--?[\w-]+)\"", (root / name).read_text(encoding="utf-8")))
    for word in rest:
        option = OPTION.match(word)
        if option and option[0] not in known and not re.match(r"^-\d", word):
            yield f"{name} has no option {option[0]}"


def missing_files(words, root):
    """Files in folders of the checkout that are not there. PATH=... names are left to the shell."""
    for word in words:
        name = word.rstrip("/")
        is_ours = name.startswith(FOLDERS) and not re.search(r"[$=*?]", name)
        if is_ours and not (root / name).exists():
            yield f"there is no {name}"
