# SPDX-License-Identifier: Apache-2.0
"""Compares what two builds of viewloom show, byte by byte.

    PYTHONPATH=AFTER/client/python compare_builds.py BEFORE AFTER [--only TEXT] [--quick]

BEFORE and AFTER are build folders on this machine: bits differ from machine to machine. The commit
before is built in a worktree of its own (`git worktree add ../before HEAD~1`). Each build
publishes the scenes of scenes.py with its own client to its own server, which is then asked for
the displays of displays.py. Also compared: pictures between frames, as `viewloom render` writes
them, what a server says of an atlas (its layout, coverage, shares), and why it refuses one.

Ends with 1 where anything differs, and says by how much where it knows the samples."""

import argparse
import pathlib
import sys
import tempfile

import numpy as np

import displays
import scenes
from served_build import ServedBuild

SAMPLES = {"ATLAS_PLANE_COLOR": np.uint8, "ATLAS_PLANE_DEPTH": np.float32,
           "ATLAS_PLANE_MASK": np.uint8, "ATLAS_PLANE_DEPTH_CODES": np.uint16}
# One of every way of making, moving and packing a picture, in a minute.
SHORT_FORM = {"two-layers: quilt, raw", "two-layers: quilt, jpeg", "two-layers: cameras",
              "two-layers: stereo-tracked 1", "one-layer: rgbd-16, zstd", "predicted"}


def difference(plane, before, after):
    """How two planes differ, in words; empty where they do not."""
    if before == after:
        return ""
    if before is None or after is None:
        return "is in one of the builds only"
    _, kind, packing = plane
    if packing != "BAND_ENCODING_RAW" or len(before) != len(after):
        return f"differs ({len(before)} and {len(after)} bytes)"
    samples = [np.frombuffer(data, SAMPLES[kind]).astype(np.float64) for data in (before, after)]
    with np.errstate(invalid="ignore"):
        apart = np.abs(samples[0] - samples[1])
    unequal = ~((samples[0] == samples[1]) | np.isnan(samples[0]) & np.isnan(samples[1]))
    return f"differs by up to {np.nanmax(apart):g} in {np.mean(unequal):.2%} of the samples"


def differences(before, after):
    """All of two answers, a line each."""
    for plane in sorted({*before.planes, *after.planes}):
        text = difference(plane, before.planes.get(plane), after.planes.get(plane))
        if text:
            yield f"image {plane[0]}, {plane[1]} {text}"
    for name in sorted({*before.words, *after.words}):
        if before.words.get(name) != after.words.get(name):
            yield f"{name}: {before.words.get(name)} before, {after.words.get(name)} after"


def served(scene, request):
    return lambda build, _: build.ask(scene, *request)


def rendered(display, arguments):
    return lambda build, folder: build.render(folder, display, arguments)


def comparisons(files):
    """(name, scene or None, how a build answers) of everything that is compared."""
    for scene in scenes.published(files):
        for name, *request in displays.requests():
            yield f"{scene}: {name}", scene, served(scene, request)
    for name, (display, later_s) in displays.BETWEEN_FRAMES.items():
        yield name, None, rendered(display, [*scenes.rendered(files), "--later", str(later_s)])


def compare(builds, files, wanted, is_verbose):
    for scene in {scene: None for _, scene, _ in wanted if scene}:
        for build in builds:
            build.publish(scene, scenes.published(files)[scene])
    wrong = refused = 0
    for count, (name, _, answer) in enumerate(wanted):
        answers = [answer(build, files / f"{count}-{side}") for side, build in enumerate(builds)]
        found = list(differences(*answers))
        for text in found:
            print(f"{name}: {text}", flush=True)
        if is_verbose:
            said = answers[0].words
            print(f"{name}: {said.get('refused', said.get('method', 'rendered'))}", flush=True)
        wrong += bool(found)
        refused += "refused" in answers[0].words
    print(f"{len(wanted)} compared: {wrong} differ; {refused} were refused before")
    return wrong


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--only", default="", metavar="TEXT", help="only names with TEXT in them")
    parser.add_argument("--quick", action="store_true", help="one of every kind")
    parser.add_argument("--verbose", action="store_true", help="say how each picture was made")
    arguments = parser.parse_args(words)

    with tempfile.TemporaryDirectory() as scratch:
        files = pathlib.Path(scratch)
        scenes.write_files(files)
        wanted = [comparison for comparison in comparisons(files)
                  if arguments.only in comparison[0]
                  and (not arguments.quick or comparison[0] in SHORT_FORM)]
        builds = []
        try:
            for folder in (arguments.before, arguments.after):
                builds.append(ServedBuild(folder))
            return 1 if compare(builds, files, wanted, arguments.verbose) else 0
        finally:
            for build in builds:
                build.stop()


if __name__ == "__main__":
    sys.exit(main())
