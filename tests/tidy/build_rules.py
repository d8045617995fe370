# SPDX-License-Identifier: Apache-2.0
"""Rules on what is built: no dead files, no globs, nothing binary or generated in the tree."""

import os
import re

from layering import INCLUDE, resolve
from link_rules import linked_files
from tree import Finding

PICTURES = (".png", ".jpg", ".jpeg")
GENERATED = re.compile(r"(\.pb\.(h|cc)|_pb2(_grpc)?\.py|\.spv|\.o|\.a|\.so|\.pyc|\.class|\.log)$"
                       r"|(^|/)(build|__pycache__|node_modules|CMakeFiles)/")
SOURCES = (".cpp", ".h", ".comp", ".vert", ".frag", ".glsl", ".proto", ".py", ".js", ".css",
           ".html")
EMBEDDED = (".html", ".css", ".js", ".vert", ".frag")


def check_artefacts(tree):
    shown = linked_files(tree)
    for path in tree.paths():
        if GENERATED.search(path):
            yield Finding(path, 0, "generated", "belongs in the build folder")
        elif tree.is_binary(path) and not (path.endswith(PICTURES) and path in shown):
            yield Finding(path, 0, "binary", "only pictures that a Markdown file shows may be")


def _words_of_lists(tree):
    """For each folder with a CMakeLists.txt, the file names written in it."""
    words = {}
    for path in tree.text_files("CMakeLists.txt", ".cmake"):
        text = "\n".join(line.split("#")[0] for line in tree.lines(path))
        words.setdefault(os.path.dirname(path), set()).update(re.findall(r"[\w./+${}-]+", text))
    return words


def _names(word, relative, words):
    """Whether a word of a list is this path; ${variable} stands for part of a name.

    Without anything but the variable, the name itself must be among the list's words.
    """
    if "${" not in word:
        return word == relative or word.endswith("/" + relative)
    literals = re.split(r"\$\{\w+\}", os.path.basename(word))
    if not re.fullmatch(r"\w+".join(re.escape(literal) for literal in literals), relative):
        return False
    has_stem = any(literal.split(".")[0] for literal in literals)
    return has_stem or os.path.splitext(relative)[0] in words


def _is_listed(path, words_of_folder):
    """Whether a list in the file's folder or above it names the file relative to itself.

    The page and the client's shaders are embedded by lists that are not above them.
    """
    if path.endswith(EMBEDDED):
        return any(_names(word, os.path.basename(path), words)
                   for words in words_of_folder.values() for word in words)
    folder = os.path.dirname(path)
    while True:
        words = words_of_folder.get(folder, ())
        relative = os.path.relpath(path, folder or ".")
        if any(_names(word, relative, words) for word in words):
            return True
        if not folder:
            return False
        folder = os.path.dirname(folder)


def _mentions(tree):
    """Every file that another file includes, imports or names."""
    mentioned = set()
    for path in tree.text_files(".h", ".cpp", ".glsl", ".comp"):
        for line in tree.lines(path):
            match = INCLUDE.match(line)
            included = match and resolve(tree, path, match.group(2))
            if included and included != path:
                mentioned.add(included)
    for path in tree.text_files(".py", ".js", ".html", ".md", ".sh", ".css"):
        folder = os.path.dirname(path)
        text = "\n".join(tree.lines(path))
        for module in re.findall(r"^\s*(?:from|import)\s+([\w.]+)", text, re.MULTILINE):
            mentioned.add(os.path.join(folder, module.replace(".", "/") + ".py"))
        for name in re.findall(r"[\w./-]+\.(?:py|js|css|html)\b", text):
            for base in (folder, ""):
                mentioned.add(os.path.normpath(os.path.join(base, name.lstrip("/"))))
    return mentioned


def check_dead(tree):
    words = _words_of_lists(tree)
    mentioned = _mentions(tree)
    for path in tree.text_files(*SOURCES):
        # A header that only its own .cpp includes is alive through it; an unlisted .cpp is dead.
        is_mentioned = path in mentioned and not path.endswith((".cpp", ".comp", ".proto"))
        if not is_mentioned and not _is_listed(path, words):
            yield Finding(path, 0, "dead", "no CMakeLists.txt lists it and nothing includes it")


def check_own_header(tree):
    """x.cpp includes x.h before anything else: the proof that x.h stands alone."""
    for path in tree.text_files(".cpp"):
        own = path[:-len(".cpp")] + ".h"
        if own not in tree:
            continue
        for number, line in enumerate(tree.lines(path), 1):
            match = INCLUDE.match(line)
            if match:
                if resolve(tree, path, match.group(2)) != own:
                    yield Finding(path, number, "own header", f"include {own} first")
                break


def check_globs(tree):
    for path in tree.text_files("CMakeLists.txt", ".cmake"):
        for number, line in enumerate(tree.lines(path), 1):
            if re.search(r"\bGLOB(_RECURSE)?\b", line.split("#")[0]):
                yield Finding(path, number, "glob", "list the files")


def check(tree):
    for rule in (check_artefacts, check_dead, check_own_header, check_globs):
        yield from rule(tree)
