#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How long an atlas takes over gRPC: from when the last chunk of a frame is sent to when the first
and the last band of its atlas, and its end, are here. The next frame is sent once that has come, so
that none waits for another. Arguments: build folders of any age, which take turns. Prints medians,
as text or with --json, and judges none. Needs the generated Python stubs:
PYTHONPATH=BUILD/client/python."""

import argparse
import json
import pathlib
import queue
import statistics
import sys
import threading
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "atlases"))
from displays import DISPLAYS, LENS  # noqa: E402
from served_build import ServedBuild  # noqa: E402
from viewloom import Source  # noqa: E402
from viewloom.frame_messages import frame_messages  # noqa: E402
from viewloom.v1.ingest_service_pb2 import PublishFramesRequest  # noqa: E402

STREAM = "measured"
QUILT = {"quilt": {"columns": 8, "rows": 6, "size": {"width": 3360, "height": 3360}}}
SMALL_QUILT = {"quilt": {"columns": 5, "rows": 4, "size": {"width": 1600, "height": 1280}}}
# One that stands elsewhere than its source is walked.
IN_WORLD = {"world_pose": DISPLAYS["quilt-in-world"]["world_pose"]}
KINDS = {
    "swept quilt": (QUILT, {}),
    "swept quilt with depth": (QUILT, {"with_depth": True}),
    "swept quilt as video": (QUILT, {"color": "BAND_ENCODING_H264"}),
    "walked quilt": ({**SMALL_QUILT, **IN_WORLD}, {}),
    "lens": ({**SMALL_QUILT, "effects": {"lens": LENS}}, {}),
}
MARKS = ("first band", "last band", "end")


def source(size_px, number):
    """A ball before a wall; each frame differs from the last."""
    width, height = size_px
    y, x = np.mgrid[0:height, 0:width]
    is_ball = np.hypot(x - width / 2 - number, y - height / 2) < height / 4
    color = np.stack([np.where(is_ball, 220, x % 256), y % 256, (x + y + number) % 256], axis=-1)
    return Source(color.astype(np.uint8), np.where(is_ball, 1.5, 3).astype(np.float32),
                  fov_y_rad=0.6)


class Sender:
    """Sends frames one after the other, and tells when the last chunk of one was on its way."""

    def __init__(self, build):
        self._frames = queue.SimpleQueue()
        self._sent = queue.SimpleQueue()
        self._call = build.send_frames(self._requests())
        self._reader = threading.Thread(target=self._read_reports)
        self._reader.start()

    def _requests(self):
        yield PublishFramesRequest(settings={"stream": STREAM})
        while (messages := self._frames.get()) is not None:
            yield from messages
            self._sent.put(time.monotonic())  # gRPC asks for the next once it has sent the last

    def _read_reports(self):
        for _ in self._call:
            pass

    def send(self, number, size_px):
        self._frames.put(frame_messages(number, source(size_px, number), capture_time_ns=number))
        return self._sent.get()

    def stop(self):
        self._frames.put(None)
        self._reader.join()


class Arrivals:
    """When the parts of each atlas of a viewer came, by frame number."""

    def __init__(self, build, display, encoding):
        self._times = {}
        self._open = {}
        self._changed = threading.Condition()
        self._watching = build.watch_messages(STREAM, display, encoding, self._note)

    def _note(self, message):
        now = time.monotonic()
        kind = message.WhichOneof("message")
        if kind == "header":
            self._open = {"frame": message.header.frame_number}
        elif kind == "band":
            self._open.setdefault("first band", now)
            self._open["last band"] = now
        elif kind == "end":
            with self._changed:
                self._times[self._open["frame"]] = {**self._open, "end": now}
                self._changed.notify()

    def wait_for(self, frame):
        with self._changed:
            if not self._changed.wait_for(lambda: frame in self._times, timeout=120):
                raise TimeoutError(f"no atlas of frame {frame} came")
            return self._times[frame]

    def stop(self):
        self._watching.stop()


def measure(folder, kind, arguments):
    """Lists of ms, of all frames but the first, which warm up."""
    build = ServedBuild(folder)
    figures = {mark: [] for mark in MARKS}
    try:
        sender = Sender(build)
        arrivals = Arrivals(build, *KINDS[kind])
        for number in range(1, arguments.frames + arguments.warm_up + 1):
            sent = sender.send(number, arguments.size)
            atlas = arrivals.wait_for(number)
            if number > arguments.warm_up:
                for mark in MARKS:
                    figures[mark].append(1e3 * (atlas[mark] - sent))
        sender.stop()
        arrivals.stop()
        return figures
    finally:
        build.stop()


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("builds", nargs="+", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=10, help="measured in each round")
    parser.add_argument("--warm-up", type=int, default=3, help="frames before those")
    parser.add_argument("--size", type=size_of, default=(960, 540), help="px of the source")
    parser.add_argument("--only", choices=sorted(KINDS), help="this kind alone")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    results = []
    for kind in [arguments.only] if arguments.only else list(KINDS):
        figures = {folder: {mark: [] for mark in MARKS} for folder in arguments.builds}
        for _ in range(arguments.rounds):
            for folder in arguments.builds:
                for mark, values in measure(folder, kind, arguments).items():
                    figures[folder][mark] += values
        for folder, marks in figures.items():
            medians = {f"{mark} ms": statistics.median(values) for mark, values in marks.items()}
            results.append({"kind": kind, "build": str(folder), **medians})
            if not arguments.json:
                print(f"{kind:24} {str(folder):28} " + "  ".join(
                    f"{name} {value:7.1f}" for name, value in medians.items()), flush=True)
    if arguments.json:
        print(json.dumps(results))


if __name__ == "__main__":
    main()
