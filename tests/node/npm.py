# SPDX-License-Identifier: Apache-2.0
"""Runs npm. Without Node, or without npm's registry, a test is skipped and says why, but where
VIEWLOOM_REQUIRE_NODE is 1."""

import os
import shutil
import subprocess
import sys

PATIENCE_S = 120
SKIPPED = 77  # as CMakeLists.txt says
class Missing(Exception):
    """Something the test cannot run without."""


def run(*words, cwd):
    """What npm prints in that folder."""
    for program in ("node", "npm"):
        if not shutil.which(program):
            raise Missing(f"there is no {program}: install it, or Debian's package of that name")
    return subprocess.run(["npm", "--no-update-notifier", *words], cwd=cwd, check=True,
                          stdout=subprocess.PIPE, text=True, timeout=PATIENCE_S).stdout


def install(*words, cwd):
    """Runs an npm command that fetches packages."""
    try:
        run(*words, "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline",
            "--fetch-retries=1", "--fetch-retry-mintimeout=2000", "--fetch-timeout=20000", cwd=cwd)
    except subprocess.SubprocessError as problem:
        raise Missing(f"npm could not install packages, its message is above: {problem}") from None


def require(prepare):
    """Calls prepare. Ends the test, skipped or failed, where it finds something missing."""
    try:
        prepare()
    except Missing as missing:
        is_required = os.environ.get("VIEWLOOM_REQUIRE_NODE") == "1"
        print(f"{'VIEWLOOM_REQUIRE_NODE is 1, but' if is_required else 'skipped:'} {missing}")
        sys.exit(1 if is_required else SKIPPED)
