# SPDX-License-Identifier: Apache-2.0
"""The same attacks on an older server and on a newer one, in one table.

Each attack gets a server of its own, in a process of its own, which is ended when it takes too
long: an older server may hang for good.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

PATIENCE_S = 150  # for one attack on one server, its start and its end included
HEADER = ("Pictures seen of those due, longest gap, peak of memory, CPU time; what was found.\n\n"
          "| attack | before | after |\n|---|---|---|")


def known_settings(program, settings):
    """The settings, names and values in turn, that a server knows: an older one lacks some."""
    text = subprocess.run([program, "--help"], capture_output=True, text=True,
                          timeout=30).stdout
    pairs = zip(settings[::2], settings[1::2])
    return tuple(word for name, value in pairs if name in text.split() for word in (name, value))


def cell_of(output, name):
    """The row of an attack in the output of main.py as one cell; None if there is none."""
    for line in output.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 6 and cells[0] == name:
            _, pictures, gap_s, memory_mib, cpu_s, found = cells
            return f"{pictures}, {gap_s} s, {memory_mib} MiB, {cpu_s} s; {found}"
    return None


def measured(program, name, is_short, patience_s=PATIENCE_S, script=None):
    """What one attack did, in words."""
    script = script or Path(__file__).with_name("main.py")
    command = [sys.executable, "-B", str(script), program, *(["--short"] if is_short else []), name]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          start_new_session=True) as process:
        try:
            output, errors = process.communicate(timeout=patience_s)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return f"not over after {patience_s:.0f} s"
    return cell_of(output, name) or f"not measured: {(errors.strip() or 'no row').splitlines()[-1]}"


def table(before, after, names, is_short):
    """Prints a row for each attack. True if the newer server did what it should."""
    print(HEADER, flush=True)
    is_good = True
    for name in names:
        cells = [measured(program, name, is_short) for program in (before, after)]
        print(f"| {name} | {cells[0]} | {cells[1]} |", flush=True)
        is_good = is_good and cells[1].endswith("; ok")
    return is_good
