# SPDX-License-Identifier: Apache-2.0
"""write_manual.py PROGRAM SECTION VERSION FOLDER: man pages and completions of a program.

In FOLDER: man/*.SECTION, one of the program and one for each command, bash/NAME and zsh/_NAME.
"""

import pathlib
import shutil
import sys

import bash_completion
import help_page
import man_page
import zsh_completion


def main(program, section, version, folder):
    name = pathlib.Path(program).name
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    for kind in ("man", "bash", "zsh"):
        (folder / kind).mkdir(parents=True)
    pages = help_page.read_pages(program, name)
    for page in pages:
        file = folder / "man" / f"{'-'.join(page.words)}.{section}"
        file.write_text(man_page.written(page, pages, section, version), encoding="utf-8")
    (folder / "bash" / name).write_text(bash_completion.written(pages), encoding="utf-8")
    (folder / "zsh" / f"_{name}").write_text(zsh_completion.written(pages), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
