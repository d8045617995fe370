# SPDX-License-Identifier: Apache-2.0
"""Rules over all documents: whole_tree.py DOCUMENT... with the documents that have a test.

Each document with commands or programs has one. At most NOT_RUN_MAX blocks of the tree say that the
tests do not run them. No short form is left over. Files that prose names are there.
"""

import pathlib
import re
import subprocess
import sys

from blocks import SNIPPETS, code_spans, read_blocks, wrong_languages
from short_forms import BESIDE, FORMS

ROOT = pathlib.Path(__file__).parents[2]
NOT_RUN_MAX = 15
FILE = re.compile(r"(client|deploy|proto|server|shaders|tests)/[\w./-]+")
PLACEHOLDER = re.compile(r"\bNAME\b")


def documents_of(root):
    """Name → text of all Markdown files that git knows, and of new ones."""
    listed = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached",
                             "--others", "--exclude-standard", "*.md"], cwd=root, check=True,
                            capture_output=True).stdout.decode().split("\0")
    return {name: (root / name).read_text(encoding="utf-8") for name in sorted(set(listed))
            if name and (root / name).is_file()}


def blocks_of(documents):
    return {name: read_blocks(name, text) for name, text in documents.items()}


def not_run(documents):
    """All blocks with a reason."""
    return [block for blocks in blocks_of(documents).values() for block in blocks if block.reason]


def untested(documents, tested):
    """Sentences about documents without a test, and about tests without something to run."""
    needed = {name for name, blocks in blocks_of(documents).items()
              if any(block.holds_commands() or block.language in SNIPPETS for block in blocks)}
    for name in sorted(needed - set(tested)):
        yield f"{name} has commands or programs: add it to tests/documents/CMakeLists.txt"
    for name in sorted(set(tested) - needed):
        yield f"{name} has nothing to run: take it out of tests/documents/CMakeLists.txt"


def left_over(documents, forms, beside):
    """Sentences about entries of short_forms.py that no command needs any more."""
    commands = {}
    for name, blocks in blocks_of(documents).items():
        commands[name] = [command.text for block in blocks if block.holds_commands()
                          for command in block.commands()]
        commands[name] += [block.text for block in blocks if block.language in SNIPPETS]
    for form in forms:
        for name in form.documents:
            if not any(re.search(form.pattern, text, re.MULTILINE)
                       for text in commands.get(name, [])):
                yield f"{name}: no command needs the short form {form.pattern}"
    for name, text in beside:
        if text not in commands.get(name, []):
            yield f"{name}: there is no command \"{text}\" to run something beside"


def missing_files(documents, root):
    """Sentences about `code` that is the path of no file, with or without its ending."""
    for name, text in documents.items():
        for line, span in code_spans(text):
            if not FILE.fullmatch(span) or PLACEHOLDER.search(span):
                continue
            path = root / span
            if not path.exists() and not list(path.parent.glob(path.name + ".*")):
                yield f"{name}:{line}: there is no {span}"


def problems_of(documents, tested, forms=FORMS, beside=tuple(BESIDE)):
    for blocks in blocks_of(documents).values():
        yield from wrong_languages(blocks)
    yield from untested(documents, tested)
    yield from left_over(documents, forms, beside)
    count = len(not_run(documents))
    if count > NOT_RUN_MAX:
        yield f"the tests do not run {count} blocks, accepted are {NOT_RUN_MAX}: run some of them"


def main(tested):
    documents = documents_of(ROOT)
    for block in not_run(documents):
        print(f"{block.document}:{block.line}: not run: {block.reason}")
    problems = [*problems_of(documents, tested), *missing_files(documents, ROOT)]
    for problem in problems:
        print(f"FAILED {problem}")
    print(f"{len(documents)} documents read, {len(not_run(documents))} blocks not run")
    return 1 if problems or not documents else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
