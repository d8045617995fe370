#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How often an atlas of H.264 is encoded for many viewers of one display: what the server counts,
beside the atlases that come. All viewers watch before the first frame, and the server is asked once
all is still, so that nothing is counted in part. Arguments: viewloomd, viewloom. Prints the largest
count and the median time of the rounds, as a table or with --json, and judges none. Needs the
Python package: PYTHONPATH=BUILD/client/python."""

import argparse
import json
import statistics
import time

import serving
from undecoded_viewer import PATIENCE_S, UndecodedViewer, encodings

STREAM = "shared"
STILL_S = 2
COUNTED = {
    "atlases": "viewloom_atlases_encoded_total",
    "pictures": "viewloom_video_pictures_total",
    "bytes": "viewloom_encoded_bytes_total",
    "encode s": 'viewloom_stage_seconds_sum{stage="encode"}',
    "encodes timed": 'viewloom_stage_seconds_count{stage="encode"}',
    "sent": serving.GRPC_SENT,
}


def counts(server):
    metrics = server.metrics()
    return {name: metrics[metric] for name, metric in COUNTED.items()}


def counts_at_rest(server):
    """Once nothing has been encoded or sent for a while."""
    deadline, since_s, last = time.monotonic() + PATIENCE_S, time.monotonic(), counts(server)
    while time.monotonic() - since_s < STILL_S:
        if time.monotonic() > deadline:
            raise TimeoutError(f"atlases are still sent after {PATIENCE_S} s")
        time.sleep(0.2)
        if (now := counts(server)) != last:
            since_s, last = time.monotonic(), now
    return last


def figures_of(encoded, seen):
    """encoded: counts of the server; seen: the atlases of each viewer."""
    distinct, digests = {}, {}
    for atlas in (atlas for atlases in seen for atlas in atlases):
        name = (atlas.rung, atlas.sequence)
        distinct[name] = atlas
        digests.setdefault(name, set()).add(atlas.digest)
    # Each rung counts its atlases from 1, also those that every viewer skipped.
    made = sum(max(sequence for other, sequence in distinct if other == rung)
               for rung in {rung for rung, _ in distinct})
    first = next(iter(distinct.values()))
    return {"atlases": made,
            "encodes per atlas": encoded["atlases"] / made,
            "pictures coded per picture": encoded["pictures"] / (made * first.picture_count),
            "bytes coded per byte": encoded["bytes"] / sum(
                atlas.size_bytes for atlas in distinct.values()),
            "atlases of different bytes": sum(len(alike) > 1 for alike in digests.values()),
            "received per atlas": sum(len(atlases) for atlases in seen) / made,
            "encode ms": 1e3 * encoded["encode s"] / encoded["encodes timed"]}


def measure(arguments, count):
    encoding = encodings(arguments.qp)["H.264, chained" if arguments.chained else "H.264"]
    server, viewers = serving.Server(arguments), []
    try:
        before = counts(server)
        viewers = [UndecodedViewer(server.grpc_address, STREAM, arguments.display, encoding)
                   for _ in range(count)]
        publisher = server.start(
            "publish", "--synthetic", "--layers", "2", "--size", arguments.size, "--fps",
            str(arguments.fps), "--seconds", str(arguments.seconds), "--stream", STREAM)
        if publisher.wait(PATIENCE_S + arguments.seconds) != 0:
            raise RuntimeError(f"{publisher.args} ended with {publisher.returncode}")
        for viewer in viewers:
            viewer.wait_for(lambda atlases: atlases)
        after = counts_at_rest(server)
    finally:
        for viewer in viewers:
            viewer.stop()
        server.stop()
    return figures_of({name: after[name] - before[name] for name in COUNTED},
                      [viewer.atlases() for viewer in viewers])


def rows_of(arguments):
    rounds = {count: [] for count in arguments.viewers}
    for _ in range(arguments.rounds):
        for count in arguments.viewers:
            rounds[count].append(measure(arguments, count))
    return [{"viewers": count,
             **{key: max(one[key] for one in figures) for key in figures[0]},
             "encode ms": statistics.median(one["encode ms"] for one in figures)}
            for count, figures in rounds.items()]


def print_table(rows):
    names = [name for name in rows[0] if name not in ("viewers", "atlases")]
    print(f"| viewers | atlases | {' | '.join(names)} |\n" + "|---" * (len(names) + 2) + "|")
    for row in rows:
        print(f"| {row['viewers']} | {row['atlases']:.0f} | " +
              " | ".join(f"{row[name]:.2f}" for name in names) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("--viewers", type=lambda text: [int(count) for count in text.split(",")],
                        default=[1, 64])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=10, help="of the moving scene")
    parser.add_argument("--fps", type=float, default=2, help="of the source, less than served")
    parser.add_argument("--size", default="720x960", help="px of the source")
    parser.add_argument("--display", type=json.loads, default={"preset": "portrait"},
                        help="JSON of Display")
    parser.add_argument("--qp", type=int, default=24,
                        help="24 has the error of JPEG 85; 0 = follows the lines")
    parser.add_argument("--chained", action="store_true", help="atlases refer to the one before")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rows = rows_of(arguments)
    if arguments.json:
        print(json.dumps(rows))
    else:
        print_table(rows)


if __name__ == "__main__":
    main()
