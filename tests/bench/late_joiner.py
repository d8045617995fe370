#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How long a viewer waits for its first picture if it joins a display that another one watches: the
time from its open message to its first whole atlas, and to the pixels of that, as JPEG, H.264 and
chained H.264. Once while the scene moves, and once after it has come to rest. Arguments: viewloomd,
viewloom. Prints medians, as a table or with --json, and judges none. Encodings take turns within a
round. The share of JPEG is the median of the rounds. Needs the Python package:
PYTHONPATH=BUILD/client/python."""

import argparse
import json
import queue
import random
import statistics
import time

import grpc

import serving
from paced_line import PacedLine
from undecoded_viewer import PATIENCE_S, UndecodedViewer, encodings
from viewloom.atlas_inbox import AtlasInbox
from viewloom.connection import CHANNEL_OPTIONS
from viewloom.display import open_request
from viewloom.v1.display_service_pb2_grpc import DisplayServiceStub

SCENES = ("moving", "standing")
STANDS_S = 1  # without an atlas
TIMES = ("whole ms", "decoded ms")


def join(address, stream, display, encoding):
    """Times of a new viewer, which is connected but watches nothing yet."""
    requests = queue.SimpleQueue()
    requests.put(open_request(stream, display, encoding, count=0, wait_for_stream=False))
    inbox = AtlasInbox(stream)
    with grpc.insecure_channel(address, options=CHANNEL_OPTIONS) as channel:
        grpc.channel_ready_future(channel).result(PATIENCE_S)
        opened_s = time.monotonic()
        call = DisplayServiceStub(channel).StreamAtlases(iter(requests.get, None),
                                                         timeout=PATIENCE_S)
        for message in call:
            whole_s = time.monotonic()
            inbox.add(message)  # decodes what is chained
            if inbox.is_ready():
                break
        atlas = inbox.take()
        height, width, _ = atlas.color.shape
        decoded_s = time.monotonic()
        call.cancel()
        requests.put(None)
    return {"KB": sum(len(band.data) for band in atlas.bands) / 1000, "px": width * height,
            "whole ms": 1e3 * (whole_s - opened_s), "decoded ms": 1e3 * (decoded_s - opened_s)}


def is_under_way(atlases, is_chained):
    """Of chained video, a joiner has no use for the newest atlas."""
    return len(atlases) >= 3 and (atlases[-1].refers or not is_chained)


def one_join(server, stream, scene, encoding, mbit, arguments, phase):
    """Joins a display that has a viewer, of a stream of its own. phase: moment between two frames,
    from 0 to 1."""
    publisher = server.start("publish", "--synthetic", "--layers", "2", "--size", arguments.size,
                             "--fps", str(arguments.fps), "--stream", stream)
    viewer = UndecodedViewer(server.grpc_address, stream, arguments.display, encoding)
    line = PacedLine(server.grpc_address, mbit) if mbit else None
    is_chained = encoding.get("prediction") == "PREDICTION_ACROSS_ATLASES"
    try:
        viewer.wait_for(lambda atlases: is_under_way(atlases, is_chained))
        if scene == "standing":
            publisher.terminate()
            publisher.wait(PATIENCE_S)
            viewer.wait_for_quiet(STANDS_S)
        else:
            time.sleep(phase / arguments.fps)
        return join(line.address if line else server.grpc_address, stream, arguments.display,
                    encoding)
    finally:
        viewer.stop()
        if line:
            line.close()
        publisher.terminate()
        publisher.wait(PATIENCE_S)


def measure(server, arguments):
    """Lists of what join() gives, by (scene, mbit, encoding); one for each round."""
    joins, count = {}, 0
    kinds = list(encodings(arguments.qp).items())
    for number in range(arguments.rounds):
        phase = random.Random(number).random()
        for scene in arguments.scenes:
            for mbit in arguments.mbit:
                first = number % len(kinds)
                for name, encoding in kinds[first:] + kinds[:first]:
                    count += 1
                    joins.setdefault((scene, mbit, name), []).append(one_join(
                        server, f"joined{count}", scene, encoding, mbit, arguments, phase))
    return joins


def rows_of(joins):
    rows = []
    for (scene, mbit, name), rounds in joins.items():
        row = {"scene": scene, "Mbit/s": mbit, "encoding": name}
        row.update({key: statistics.median(one[key] for one in rounds) for key in rounds[0]})
        jpegs = joins[scene, mbit, "JPEG"]
        for key in TIMES:
            row[f"{key} of JPEG"] = statistics.median(
                one[key] / jpeg[key] for one, jpeg in zip(rounds, jpegs))
            values = [one[key] for one in rounds]
            row[f"{key} range"] = [min(values), max(values)]
        rows.append(row)
    return sorted(rows, key=lambda row: (row["scene"], row["Mbit/s"]))


def print_table(rows):
    print("| scene | line, Mbit/s | encoding | KB | whole after, ms | of JPEG | decoded after, ms "
          "| of JPEG |\n|---|---|---|---|---|---|---|---|")
    for row in rows:
        times = " | ".join(
            "{:.0f} ({:.0f} to {:.0f}) | {:.2f}".format(
                row[key], *row[f"{key} range"], row[f"{key} of JPEG"]) for key in TIMES)
        print(f"| {row['scene']} | {row['Mbit/s'] or 'loopback'} | {row['encoding']} | "
              f"{row['KB']:.0f} | {times} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=SCENES)
    parser.add_argument("--size", default="720x960", help="px of the source")
    parser.add_argument("--fps", type=float, default=4, help="of the source, less than served")
    parser.add_argument("--display", type=json.loads, default={"preset": "portrait"},
                        help="JSON of Display")
    parser.add_argument("--qp", type=int, default=24, help="24 has the error of JPEG 85")
    parser.add_argument("--mbit", type=float, nargs="+", default=[0],
                        help="speeds of the joiner's line, Mbit/s; 0 = loopback")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    server = serving.Server(arguments)
    try:
        rows = rows_of(measure(server, arguments))
    finally:
        server.stop()
    if arguments.json:
        print(json.dumps(rows))
    else:
        print_table(rows)


if __name__ == "__main__":
    main()
