#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a running viewloomd takes for many clients of one display, and for different displays of
one stream: the CPU time of its process for each atlas and client, beside what it takes to write the
same bytes to as many sockets, and how often frames are uploaded, built, traced and encoded."""

import argparse
import contextlib
import datetime
import json
import os
import pathlib
import re
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request

STREAM = "bench"
PATIENCE_S = 300
GRPC_SENT = 'viewloom_atlases_sent_total{transport="grpc"}'
GRPC_BYTES = 'viewloom_sent_bytes_total{transport="grpc"}'
COUNTED = {
    "frames": "viewloom_frames_received_total",
    "uploads": 'viewloom_stage_seconds_count{stage="upload"}',
    "builds": "viewloom_structures_built_total",
    "swept": 'viewloom_atlases_traced_total{method="sweep"}',
    "walked": 'viewloom_atlases_traced_total{method="walk"}',
    "encoded": "viewloom_atlases_encoded_total",
    "sent": GRPC_SENT,
    "sent_bytes": GRPC_BYTES,
}
DISPLAYS = {
    "quilt": ["--preset", "portrait"],
    "stereo": {"stereo": {"eye_size": {"width": 1280, "height": 720}}},
    "grid of cameras": {"cameras": {
        "tile_size": {"width": 480, "height": 270},
        "grid": {"columns": 4, "rows": 2, "spacing_x_m": 0.02, "spacing_y_m": 0.02}}},
    "panel": ["--preset", "portrait", "--native"],
}


class Server:
    def __init__(self, arguments):
        self.client = arguments.viewloom
        self.process = subprocess.Popen(
            [arguments.viewloomd, "serve", "--http.address", "127.0.0.1:0", "--grpc.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        addresses = re.search(r"grpc=(\S+) http=(\S+)", self.process.stdout.readline())
        self.grpc_address, self.url = addresses.groups()
        self.others = []
        self.folder = tempfile.TemporaryDirectory()

    def watch(self, display):
        if isinstance(display, dict):
            message = pathlib.Path(self.folder.name) / f"{len(self.others)}.json"
            message.write_text(json.dumps(display), encoding="ascii")
            display = ["--display", message]
        self.start("watch", STREAM, *display)

    def start(self, *arguments):
        self.others.append(subprocess.Popen(
            [self.client, "--server", self.grpc_address, *arguments, "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def counts(self):
        with urllib.request.urlopen(self.url + "metrics", timeout=PATIENCE_S) as reply:
            metrics = dict(line.rsplit(" ", 1) for line in reply.read().decode().splitlines()
                           if not line.startswith("#"))
        return {name: float(metrics[metric]) for name, metric in COUNTED.items()}

    def cpu_s(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def check(self):
        for process in self.others:
            if process.poll() is not None:
                raise RuntimeError(f"{process.args} ended with {process.returncode}")

    def stop(self):
        self.folder.cleanup()
        for process in self.others:
            process.send_signal(signal.SIGINT)
        for process in self.others:
            process.wait(PATIENCE_S)
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)
        self.process.stdout.close()


@contextlib.contextmanager
def serving(arguments, watchers):
    """A server with a moving scene and these watchers, once all of them have got an atlas."""
    server = Server(arguments)
    try:
        server.start("publish", "--synthetic", "--size", arguments.size, "--layers", "2", "--rate",
                     str(arguments.rate), "--stream", STREAM)
        for watcher in watchers:
            server.watch(watcher)
        deadline = time.monotonic() + PATIENCE_S
        while server.counts()["sent"] < 2 * len(watchers):
            if time.monotonic() > deadline:
                raise TimeoutError("no atlases came")
            server.check()
            time.sleep(0.2)
        yield server
        server.check()
    finally:
        server.stop()


def measured(arguments, watchers):
    with serving(arguments, watchers) as server:
        before, cpu_before_s = server.counts(), server.cpu_s()
        time.sleep(arguments.seconds)
        after, cpu_after_s = server.counts(), server.cpu_s()
    counts = {name: after[name] - before[name] for name in COUNTED}
    counts["cpu_s"] = cpu_after_s - cpu_before_s
    return counts


def read_all(listener, size_bytes):
    connection = listener.accept()[0]
    buffer = bytearray(1 << 20)
    while size_bytes > 0:
        size_bytes -= connection.recv_into(buffer)
    os._exit(0)


def socket_copy_s_per_byte(size_bytes):
    """CPU time of a process that writes an atlas into a TCP connection to its own machine."""
    atlas, repeats = bytes(size_bytes), 50
    listener = socket.create_server(("127.0.0.1", 0))
    reader = os.fork()
    if reader == 0:
        read_all(listener, size_bytes * repeats)
    with socket.create_connection(listener.getsockname()) as connection:
        begun_s = time.process_time()
        for _ in range(repeats):
            connection.sendall(atlas)
        spent_s = time.process_time() - begun_s
    os.waitpid(reader, 0)
    listener.close()
    return spent_s / (size_bytes * repeats)


def memory_copy_s_per_byte(size_bytes):
    source, target = bytearray(size_bytes), bytearray(size_bytes)
    spent_s = []
    for _ in range(50):
        begun_s = time.process_time()
        target[:] = source
        spent_s.append(time.process_time() - begun_s)
    return statistics.median(spent_s) / size_bytes


def client_rows(arguments):
    rows = []
    display = ["--preset", "portrait", "--cone", "2"]
    for count in arguments.clients:
        run = measured(arguments, [display] * count)
        atlas_bytes = run["sent_bytes"] / run["sent"]
        row = {"clients": count,
               "traced_per_frame": (run["swept"] + run["walked"]) / run["frames"],
               "encoded_per_frame": run["encoded"] / run["frames"],
               "sent_per_atlas": run["sent"] / run["encoded"],
               "atlas_bytes": atlas_bytes,
               "cpu_ms_per_atlas": 1e3 * run["cpu_s"] / run["encoded"]}
        if rows:
            first = rows[0]
            added_s = (run["cpu_s"] / run["encoded"] - first["cpu_ms_per_atlas"] / 1e3) / (
                row["sent_per_atlas"] - first["sent_per_atlas"])
            row["added_ms_per_client"] = 1e3 * added_s
            row["of_socket_copy"] = added_s / atlas_bytes / socket_copy_s_per_byte(int(atlas_bytes))
            row["of_memory_copy"] = added_s / atlas_bytes / memory_copy_s_per_byte(int(atlas_bytes))
        rows.append(row)
    return rows


def display_rows(arguments):
    rows = []
    for names in (list(DISPLAYS)[:1], list(DISPLAYS)):
        run = measured(arguments, [DISPLAYS[name] for name in names])
        rows.append({"displays": names, **{
            f"{what}_per_frame": run[what] / run["frames"]
            for what in ("uploads", "builds", "swept", "walked", "encoded")}})
    return rows


def print_table(report):
    print("| clients | traced per frame | encoded | sent per atlas | server's CPU ms per atlas | "
          "added per client | of writing to a socket | of a copy in memory |\n"
          "|---|---|---|---|---|---|---|---|")
    for row in report["clients"]:
        added = (f"{row['added_ms_per_client']:.2f} ms | {row['of_socket_copy']:.1f}x | "
                 f"{row['of_memory_copy']:.1f}x" if "of_socket_copy" in row else "- | - | -")
        print(f"| {row['clients']} | {row['traced_per_frame']:.2f} | "
              f"{row['encoded_per_frame']:.2f} | {row['sent_per_atlas']:.1f} | "
              f"{row['cpu_ms_per_atlas']:.0f} | {added} |")
    print("\n| displays | uploads per frame | builds | swept | walked | encoded |\n"
          "|---|---|---|---|---|---|")
    for row in report["displays"]:
        print(f"| {', '.join(row['displays'])} | " + " | ".join(
            f"{row[what + '_per_frame']:.2f}"
            for what in ("uploads", "builds", "swept", "walked", "encoded")) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("viewloomd")
    parser.add_argument("viewloom")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--size", default="1920x1080", help="px of the source")
    parser.add_argument("--rate", type=float, default=1, help="frames a second, less than served")
    parser.add_argument("--seconds", type=float, default=20, help="of each measurement")
    parser.add_argument("--clients", type=lambda text: [int(count) for count in text.split(",")],
                        default=[1, 4, 16, 64])
    arguments = parser.parse_args()
    report = {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
              "clients": client_rows(arguments), "displays": display_rows(arguments)}
    if arguments.json:
        print(json.dumps(report, indent=2))
    else:
        print_table(report)


if __name__ == "__main__":
    sys.exit(main())
