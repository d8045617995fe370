#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""CPU seconds of compiling and linking viewloom and viewloomd, without ccache. They are the sum
over all cores, so that other work on the machine counts little. Prints tables in Markdown, and
judges none.

  whole [COMMIT]   builds a clean checkout from nothing, and says what each folder takes. With
                   --sample N, it compiles every N-th file of each folder, and scales.
  leaves BUILD     in a finished build of this checkout, what is rebuilt after a change to one
                   source file: for ten files in different folders, and their median.

Needs GNU time (Debian package time)."""

import argparse
import collections
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).parents[2]
PROGRAMS = ["viewloom", "viewloomd"]
LEAVES = [
    "client/cli/list_command.cpp", "client/files/exr_image.cpp", "client/inputs/interpret_exr.cpp",
    "client/lib/publisher.cpp", "client/offline/render_command.cpp",
    "server/core/display/quilt.cpp", "server/engine/sweep/sweep_plan.cpp",
    "server/pipeline/pipeline.cpp", "server/rpc/rpc_server.cpp", "server/web/http_server.cpp"]
LARGEST_COUNT = 10


def run_ninja(build, targets):
    """Returns its CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(["ninja", "-C", build, *targets], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "CCACHE_DISABLE": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Checkout:
    """A commit in a folder of its own, configured to log the CPU time of every compilation."""

    def __init__(self, commit, folder):
        self.source = folder / "source"
        self.build = folder / "build"
        self._log = folder / "compilations"
        self.source.mkdir()
        archive = subprocess.run(["git", "-C", REPOSITORY, "archive", commit], check=True,
                                 stdout=subprocess.PIPE).stdout
        subprocess.run(["tar", "-x", "-C", self.source], input=archive, check=True)
        launcher = f"/usr/bin/time;--append;--output={self._log};--format=%U %S %C"
        subprocess.run(
            ["cmake", "--preset", "release", "-B", self.build, "-DVIEWLOOM_TESTS=OFF",
             f"-DCMAKE_C_COMPILER_LAUNCHER={launcher}",
             f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"],
            cwd=self.source, check=True, stdout=subprocess.DEVNULL)

    def objects(self):
        """All object files of the programs, by the folder that builds them."""
        inputs = subprocess.run(["ninja", "-C", self.build, "-t", "inputs", *PROGRAMS],
                                check=True, stdout=subprocess.PIPE, text=True).stdout
        folders = collections.defaultdict(list)
        for path in sorted(inputs.split("\n")):
            if path.endswith(".o"):
                folders[path.split("CMakeFiles/")[0].rstrip("/")].append(path)
        return folders

    def compilations(self):
        """CPU seconds of every compilation so far, by its output."""
        seconds = {}
        for line in self._log.read_text().splitlines():
            user_s, system_s, command = line.split(" ", 2)
            words = command.split()
            seconds[words[words.index("-o") + 1]] = float(user_s) + float(system_s)
        return seconds


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|---" * len(head) + "|",
                      *("| " + " | ".join(row) + " |" for row in rows), ""])


def whole(commit, sample):
    with tempfile.TemporaryDirectory() as folder:
        checkout = Checkout(commit, pathlib.Path(folder))
        objects = checkout.objects()
        chosen = [path for paths in objects.values() for path in paths[::sample]]
        total_s = run_ninja(checkout.build, PROGRAMS if sample == 1 else chosen)
        compilations = checkout.compilations()
    folders = []
    for name, paths in objects.items():
        mean_s = statistics.mean(compilations[path] for path in paths[::sample])
        folders.append((name, len(paths), mean_s * len(paths)))
    headers_s = sum(seconds for path, seconds in compilations.items() if path.endswith(".gch"))
    other_s = total_s - sum(compilations.values())
    sum_s = sum(seconds for _, _, seconds in folders) + headers_s + other_s
    rows = [(name, str(count), f"{seconds:.0f}", f"{seconds / count:.1f}")
            for name, count, seconds in sorted(folders, key=lambda row: -row[2])]
    rows += [("precompiled headers", "", f"{headers_s:.0f}", ""),
             ("shaders, protoc, libraries, links", "", f"{other_s:.0f}", ""),
             ("all", str(sum(len(paths) for paths in objects.values())), f"{sum_s:.0f}", "")]
    largest = sorted(compilations.items(), key=lambda row: -row[1])[:LARGEST_COUNT]
    return (table(("folder", "files", "CPU s", "CPU s a file"), rows) + "\n"
            + table(("most expensive", "CPU s"),
                    [(path, f"{seconds:.1f}") for path, seconds in largest]))


def leaves(build):
    run_ninja(build, PROGRAMS)
    seconds = {}
    for leaf in LEAVES:
        (REPOSITORY / leaf).touch()
        seconds[leaf] = run_ninja(build, PROGRAMS)
    rows = [(leaf, f"{taken_s:.1f}") for leaf, taken_s in seconds.items()]
    return table(("changed file", "CPU s"),
                 [*rows, ("median", f"{statistics.median(seconds.values()):.1f}")])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    of_whole = commands.add_parser("whole")
    of_whole.add_argument("commit", nargs="?", default="HEAD")
    of_whole.add_argument("--sample", type=int, default=1, metavar="N")
    commands.add_parser("leaves").add_argument("build", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.command == "whole":
        print(whole(arguments.commit, arguments.sample))
    else:
        print(leaves(arguments.build))


if __name__ == "__main__":
    sys.exit(main())
