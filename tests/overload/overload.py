# SPDX-License-Identifier: Apache-2.0
"""Overloads a server of its own on loopback, and judges what others notice.

Without a figure, all. --short takes some 90 s and judges as the long form does. --suite is shorter
and judges only what no busy machine explains. PYTHONPATH has the Python client. Prints tables. The
exit code is 1 if a figure is not met.
"""

import argparse
import dataclasses
import signal
import sys
import time

import beside
import form
import overcommit
import slow_viewers
import terminations

FIGURES = {"beside": beside, "slow_viewers": slow_viewers, "terminations": terminations,
           "overcommit": overcommit}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewloomd", help="the server")
    parser.add_argument("--short", action="store_true", help="some 90 s, judged as the long form")
    parser.add_argument("--suite", action="store_true", help="shorter, judged as beside others")
    parser.add_argument("--first", type=int, default=0, help="seed of the first termination")
    parser.add_argument("--count", type=int, help="terminations")
    parser.add_argument("figures", nargs="*", choices=[*FIGURES, []],
                        help=", ".join(FIGURES))
    words = parser.parse_intermixed_args()
    its_form = form.SUITE if words.suite else form.SHORT if words.short else form.LONG
    its_form = dataclasses.replace(its_form, first=words.first,
                                   count=words.count or its_form.count)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # also ends the server
    rows = []
    for name in words.figures or FIGURES:
        begun_s = time.monotonic()
        print(f"\n### {name}", flush=True)
        rows += FIGURES[name].run(words.viewloomd, its_form)
        print(f"took {time.monotonic() - begun_s:.0f} s", flush=True)
    return 1 if any(row.found for row in rows) or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
