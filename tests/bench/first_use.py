#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What the first use of a kind of display costs: how long its own first picture takes, and for how
long a viewer whose picture is swept goes without one meanwhile. Each kind has a server of its own,
that nobody has asked for anything but the swept picture. Arguments: build folders, tried in turn.
Prints the figures, as text or with --json, and judges none. Needs the generated Python stubs:
PYTHONPATH=BUILD/client/python."""

import argparse
import json
import pathlib
import statistics
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "atlases"))
from displays import DISPLAYS, EYE_POSES, LENS, LOSSLESS  # noqa: E402
from served_build import ServedBuild  # noqa: E402

STREAM = "shared"
QUILT = {"quilt": {"columns": 8, "rows": 6, "size": {"width": 960, "height": 720}}}
IN_WORLD = {**QUILT, "world_pose": DISPLAYS["quilt-in-world"]["world_pose"]}
EYES = {"eye_size": {"width": 320, "height": 320}}
# Swept on a software device.
BYSTANDER = QUILT
FPS = 15
SCENE = ["--synthetic", "--size", "480x270", "--fps", str(FPS)]
KINDS = {
    "quilt that stands in the world": (IN_WORLD, {}, None),
    "stereo": ({"stereo": EYES}, {}, None),
    "tracked stereo": ({"stereo": {**EYES, "tracked": True}}, {}, EYE_POSES[1]),
    "cameras": (DISPLAYS["cameras"], {}, None),
    "lenticular": (DISPLAYS["lenticular"], {}, None),
    "integral": (DISPLAYS["integral"], {}, None),
    "RGBD": (DISPLAYS["rgbd"], {}, None),
    "with depth and mask": (IN_WORLD, LOSSLESS, None),
    "filtered": ({**IN_WORLD, "filter": {"sample_count": 4}}, {}, None),
    "lens": ({**QUILT, "effects": {"lens": LENS}}, {}, None),
    "exact lens": ({**QUILT, "effects": {"lens": {**LENS, "mode": "GATHER_MODE_EXACT"}}}, {},
                   None),
    "lens before a panel": (DISPLAYS["lens-panel"], {}, None),
    "reflections": ({**QUILT, "effects": {"reflection": {"bounces": 1}}}, {}, None),
}


class Arrivals:
    """When the atlases of a viewer came."""

    def __init__(self, build):
        self._times = []
        self._lock = threading.Lock()
        self._watching = build.watch(STREAM, BYSTANDER, {}, self._note)

    def _note(self):
        with self._lock:
            self._times.append(time.monotonic())

    def wait_for(self, count):
        while len(self._times) < count:
            time.sleep(0.01)

    def longest_gap_s(self, begin, end):
        with self._lock:
            times = list(self._times)
        before = [one for one in times if one <= begin][-1:]
        marks = [*before, *(one for one in times if begin < one < end), end]
        return max(later - sooner for sooner, later in zip(marks, marks[1:]))

    def stop(self):
        self._watching.stop()


def one_use(folder, kind, arguments):
    display, encoding, eyes = KINDS[kind]
    build = ServedBuild(folder)
    try:
        build.publish(STREAM, SCENE)
        bystander = Arrivals(build)
        bystander.wait_for(2)
        begin = time.monotonic()
        time.sleep(arguments.warm_up)
        asked = time.monotonic()
        answer = build.ask(STREAM, display, encoding, eyes)
        answered = time.monotonic()
        if "refused" in answer.words:
            raise RuntimeError(f"{kind}: {answer.words['refused']}")
        time.sleep(0.5)
        end = time.monotonic()
        # A frame has one answer that a viewer who comes later may share.
        time.sleep(0.2)
        asked_again = time.monotonic()
        build.ask(STREAM, display, encoding, eyes)
        figures = {"first picture s": answered - asked,
                   "later picture s": time.monotonic() - asked_again,
                   "gap before s": bystander.longest_gap_s(max(begin, asked - 3), asked),
                   "gap meanwhile s": bystander.longest_gap_s(asked, end),
                   "gap while warming up s": bystander.longest_gap_s(begin, asked)}
        bystander.stop()
        return figures
    finally:
        build.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("builds", nargs="+", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--warm-up", type=float, default=3,
                        help="seconds between the first picture of the bystander and the use")
    parser.add_argument("--only", choices=sorted(KINDS), help="this kind alone")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    kinds = [arguments.only] if arguments.only else list(KINDS)
    results = []
    for kind in kinds:
        uses = {folder: [] for folder in arguments.builds}
        for _ in range(arguments.rounds):
            for folder in arguments.builds:
                uses[folder].append(one_use(folder, kind, arguments))
        for folder, rounds in uses.items():
            medians = {name: statistics.median(one[name] for one in rounds) for name in rounds[0]}
            results.append({"kind": kind, "build": str(folder), **medians})
            if not arguments.json:
                print(f"{kind:32} {folder.name:16} " + "  ".join(
                    f"{name} {value:6.3f}" for name, value in medians.items()), flush=True)
    if arguments.json:
        print(json.dumps(results))


if __name__ == "__main__":
    main()
