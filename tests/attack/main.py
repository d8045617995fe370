# SPDX-License-Identifier: Apache-2.0
"""Attacks a server of its own on loopback, and judges a healthy pair beside it.

Arguments: viewloomd [--short | --suite] [--front haproxy|nginx | --before OLDER] [ATTACK...].
--short takes about 3 s an attack. --suite is the same, judged as beside other tests. --front puts
the reference configuration of that front before the server. --before attacks an older viewloomd,
too, and puts both in one table. PYTHONPATH has the Python client. Prints a table. The exit code is
1 if an attack did what it should not.
"""

import argparse
import contextlib
import sys

import before_after
import budget
import connection_floods
import front
import http2_floods
import judge
import message_floods
import web_floods
from measure import measure
from target import HealthyPair, Meter, Server

ALL = (http2_floods.ATTACKS + connection_floods.ATTACKS + web_floods.ATTACKS +
       message_floods.ATTACKS)
# A front answers these by itself, or its own limits count: tests/attack/front_test.py.
FRONT = http2_floods.ATTACKS + (message_floods.gzip_messages,)


def run(words):
    parts = contextlib.ExitStack()
    with parts:
        settings = before_after.known_settings(words.viewloomd, front.SETTINGS)
        server = parts.enter_context(Server(words.viewloomd, settings=settings))
        pair = HealthyPair(server.address)
        parts.callback(pair.stop)
        address, pids = server.address, [server.process.pid]
        if words.front:
            before = parts.enter_context(front.Front(words.front, server.address))
            address, pids = before.address, pids + before.pids()
        limits = judge.FRONT if words.front else judge.SUITE if words.suite else judge.FULL
        its_budget = budget.SHORT if words.short or words.suite else budget.LONG
        known = FRONT if words.front else ALL
        print(judge.HEADER)
        rows = []
        for attack in known:
            if words.attacks and attack.__name__ not in words.attacks:
                continue
            row = measure(attack, server, pair, Meter(*pids), address, its_budget)
            rows.append(judge.judged(row, limits, bool(words.front)))
            print(row.text(), flush=True)
            if not server.is_alive():
                break
    return 1 if any(row.found for row in rows) or not rows else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewloomd")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--suite", action="store_true")
    other = parser.add_mutually_exclusive_group()
    other.add_argument("--front", choices=front.KINDS)
    other.add_argument("--before", metavar="OLDER", help="viewloomd of an older version")
    parser.add_argument("attacks", nargs="*", metavar="ATTACK",
                        help=", ".join(attack.__name__ for attack in ALL))
    words = parser.parse_intermixed_args()
    if words.front and not front.program_of(words.front):
        print(f"skipped: there is no {words.front}; install it, or name it in "
              f"VIEWLOOM_{words.front.upper()}")
        return front.SKIPPED
    if words.before:
        names = words.attacks or [attack.__name__ for attack in ALL]
        return 0 if before_after.table(words.before, words.viewloomd, names, words.short) else 1
    return run(words)


if __name__ == "__main__":
    sys.exit(main())
