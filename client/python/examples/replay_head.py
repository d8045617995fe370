# SPDX-License-Identifier: Apache-2.0
"""Replays a recorded head track before a stream: one picture for each of its poses.

    PYTHONPATH=build/release/client/python \
        /usr/bin/python3 client/python/examples/replay_head.py head.jsonl --stream demo --out seen

A track is lines of {"time_ns": 8, "left": [x, y, z], "right": [x, y, z]}, metres relative to the
display, as `viewloom watch --eyes` takes them; an eye that is turned, or has a field of view of its
own, is a Camera: {"pose": {"position": {"x": 0.1}, "orientation": {"y": 0.1, "w": 0.995}}}.
"""

import argparse
import json
import pathlib
import sys
import time
from typing import Any, Iterator

from google.protobuf import json_format

import viewloom
from viewloom.v1.geometry_pb2 import Camera


def eye_from(value: Any) -> Any:
    return json_format.ParseDict(value, Camera()) if isinstance(value, dict) else value


def track_of(file: pathlib.Path) -> Iterator[dict[str, Any]]:
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.strip():
            yield json.loads(line)


def answer_to(watcher: viewloom.Watcher, pose: dict[str, Any], time_ns: int) -> viewloom.Atlas:
    """What the eyes see; pictures of earlier poses that are still on their way are left out."""
    watcher.send_eye_poses(eye_from(pose["left"]), eye_from(pose["right"]), time_ns=time_ns)
    for atlas in watcher:
        if atlas.header.eye_poses_time_ns == time_ns:
            return atlas
    raise RuntimeError("the server ended the call")


def replay(options: argparse.Namespace) -> None:
    display = {"stereo": {"tracked": True, "focal_distance_m": options.focal_distance,
                          "eye_size": {"width": options.width, "height": options.height}}}
    options.out.mkdir(parents=True, exist_ok=True)
    with viewloom.connect(options.server) as server, \
            server.watch(options.stream, display, wait_for_stream=True) as watcher:
        clock = watcher.measure_clock()
        for number, pose in enumerate(track_of(options.track)):
            moved_ns = time.monotonic_ns()
            atlas = answer_to(watcher, pose, moved_ns)
            shown_ns = time.monotonic_ns()
            watcher.report_presented(atlas, shown_ns)
            (options.out / f"{number:05d}.jpg").write_bytes(atlas.jpeg)
            header = atlas.header
            there_ns = header.eye_poses_latched_ns - clock.ahead_ns - moved_ns
            print(f"pose {number}: frame {header.frame_number}, "
                  f"{atlas.end.coverage.outside:.1%} outside, motion to picture "
                  f"{(shown_ns - moved_ns) / 1e6:.1f} ms, of that {there_ns / 1e6:.1f} ms until "
                  f"the first ray")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("track", type=pathlib.Path, help="lines of JSON, a pose each")
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--stream", default="demo")
    parser.add_argument("--width", type=int, default=960, help="px of each eye")
    parser.add_argument("--height", type=int, default=540)
    parser.add_argument("--focal-distance", type=float, default=0, help="m; 0 = the content's")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("seen"),
                        help="folder for the pairs of pictures, one beside the other")
    try:
        replay(parser.parse_args())
    except viewloom.ViewloomError as error:
        sys.exit(f"replay_head: {error}")


if __name__ == "__main__":
    main()
