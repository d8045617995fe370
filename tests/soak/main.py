# SPDX-License-Identifier: Apache-2.0
"""Lets clients of every kind come and go before a server, and measures what it loses.

Arguments: viewloomd [--suite | --hour] [--protected] [--plant LIBRARY FAULT]. Without a form it
takes 10 minutes; --suite takes 20 s and finds coarse faults only. --protected: with encryption and
access tokens that change meanwhile. --plant: the fault of planted_fault.cpp has to be found.
PYTHONPATH has the Python client, tests/attack and tests/atlases. The exit code is 1 if something
is lost, or if the soak could not show that nothing is.
"""

import argparse
import sys
import time

from soak import HOUR, SHORT, SUITE, soak


def planted(library, fault):
    """The environment of a server with that fault; empty without one."""
    return {"LD_PRELOAD": library, "VIEWLOOM_PLANTED": fault} if library else {}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewloomd")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--suite", action="store_true")
    form.add_argument("--hour", action="store_true")
    parser.add_argument("--protected", action="store_true")
    parser.add_argument("--plant", nargs=2, metavar=("LIBRARY", "FAULT"), default=("", ""))
    words = parser.parse_args()
    plan = SUITE if words.suite else HOUR if words.hour else SHORT
    begun_s = time.monotonic()
    verdict = soak(words.viewloomd, plan, words.protected, planted(*words.plant),
                   lambda text: print(f"{time.monotonic() - begun_s:6.0f} s  {text}", flush=True))
    print(verdict.text())
    if words.plant[0]:
        print("the planted fault was found" if verdict.leaks else "the planted fault was NOT found")
        return 0 if verdict.leaks else 1
    return 1 if verdict.leaks or verdict.unproven else 0


if __name__ == "__main__":
    sys.exit(main())
