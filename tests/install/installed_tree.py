# SPDX-License-Identifier: Apache-2.0
"""The build tree, installed below a scratch prefix once for all tests of a file."""

import os
import pathlib
import subprocess
import sys
import tempfile

PATIENCE_S = 240
CMAKE, BUILD, VERSION = (sys.argv.pop(1) for _ in range(3))
_folder = tempfile.TemporaryDirectory()
PREFIX = pathlib.Path(_folder.name) / "prefix"
SCRATCH = pathlib.Path(_folder.name)
ENVIRONMENT = {**os.environ, "LC_ALL": "C.UTF-8", "VIEWLOOM_PIPELINE_WARM_UP": "false"}


def run(*command, **options):
    """What the command prints; the test fails with all that it said."""
    options.setdefault("env", ENVIRONMENT)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=False, timeout=PATIENCE_S, stdin=subprocess.DEVNULL, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} ended with {done.returncode}:\n"
                             f"{done.stdout}{done.stderr}")
    return done.stdout


def install():
    run(CMAKE, "--install", BUILD, "--prefix", PREFIX)


def only(pattern):
    """The one file below the prefix that the pattern names."""
    found = list(PREFIX.glob(pattern))
    if len(found) != 1:
        raise AssertionError(f"{pattern}: found {found}")
    return found[0]
