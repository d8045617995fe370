#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a running viewloomd takes for many clients of one display, and for different displays of
one stream: the CPU time of its process for each atlas and client, beside what it takes to write the
same bytes to as many readers, and how often frames are uploaded, built, traced and encoded."""

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
WRITE_BYTES = 1 << 20  # of an atlas, as the server gathers them (kWriteBufferBytes)
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
        """A process of `viewloom` with these arguments."""
        self.others.append(subprocess.Popen(
            [self.client, "--server", self.grpc_address, *arguments, "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        return self.others[-1]

    def metrics(self):
        with urllib.request.urlopen(self.url + "metrics", timeout=PATIENCE_S) as reply:
            lines = reply.read().decode().splitlines()
        values = (line.rsplit(" ", 1) for line in lines if not line.startswith("#"))
        return {name: float(value) for name, value in values}

    def counts(self):
        metrics = self.metrics()
        return {name: metrics[metric] for name, metric in COUNTED.items()}

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


def read_all(connection):
    buffer = bytearray(1 << 20)
    while connection.recv_into(buffer) > 0:
        pass
    os._exit(0)


def connected_reader(listener):
    """A process that reads what is written into the connection, and that connection."""
    reader = os.fork()
    if reader == 0:
        with socket.create_connection(listener.getsockname()) as connection:
            listener.close()
            read_all(connection)
    return reader, listener.accept()[0]


def socket_copy_s_per_byte(size_bytes, client_count):
    """CPU time of a process that hands atlases, one after the other, to so many readers by TCP
    connections to its own machine, in writes as large as the server's."""
    atlas, repeats, spent_s = memoryview(bytes(size_bytes)), 20, []
    with socket.create_server(("127.0.0.1", 0), backlog=client_count) as listener:
        readers = [connected_reader(listener) for _ in range(client_count)]
    for _ in range(repeats):
        begun_s = time.process_time()
        for _, connection in readers:
            for first in range(0, size_bytes, WRITE_BYTES):
                connection.sendall(atlas[first:first + WRITE_BYTES])
        spent_s.append(time.process_time() - begun_s)
        time.sleep(0.1)  # as atlases come, readers wait for each
    for _, connection in readers:
        connection.shutdown(socket.SHUT_WR)
    for reader, connection in readers:
        os.waitpid(reader, 0)
        connection.close()
    return statistics.median(spent_s) / (size_bytes * client_count)


def memory_copy_s_per_byte(size_bytes):
    source, target = bytearray(size_bytes), bytearray(size_bytes)
    spent_s = []
    for _ in range(50):
        begun_s = time.process_time()
        target[:] = source
        spent_s.append(time.process_time() - begun_s)
    return statistics.median(spent_s) / size_bytes


def client_row(arguments, count, first):
    run = measured(arguments, [["--preset", "portrait", "--cone", "2"]] * count)
    atlas_bytes = run["sent_bytes"] / run["sent"]
    row = {"clients": count,
           "traced_per_frame": (run["swept"] + run["walked"]) / run["frames"],
           "encoded_per_frame": run["encoded"] / run["frames"],
           "sent_per_atlas": run["sent"] / run["encoded"],
           "atlas_bytes": atlas_bytes,
           "cpu_ms_per_atlas": 1e3 * run["cpu_s"] / run["encoded"]}
    if first:
        row["added_ms_per_client"] = (row["cpu_ms_per_atlas"] - first["cpu_ms_per_atlas"]) / (
            row["sent_per_atlas"] - first["sent_per_atlas"])
        copies = {"socket": socket_copy_s_per_byte(int(atlas_bytes), count),
                  "memory": memory_copy_s_per_byte(int(atlas_bytes))}
        for where, s_per_byte in copies.items():
            row[f"{where}_copy_ms"] = 1e3 * s_per_byte * atlas_bytes
            row[f"of_{where}_copy"] = row["added_ms_per_client"] / row[f"{where}_copy_ms"]
    return row


def client_rows(arguments):
    """Medians of the rounds, in each of which all counts have their turn: what a client adds is
    the difference to the first count of the same round."""
    rounds = []
    for _ in range(arguments.rounds):
        rows = []
        for count in arguments.clients:
            rows.append(client_row(arguments, count, rows[0] if rows else None))
        rounds.append(rows)
    return [{key: statistics.median(row[key] for row in same_count) for key in same_count[0]}
            for same_count in zip(*rounds)]


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
          "added per client | writing to a socket | of it | of a copy in memory |\n"
          "|---|---|---|---|---|---|---|---|---|")
    for row in report["clients"]:
        added = (f"{row['added_ms_per_client']:.2f} ms | {row['socket_copy_ms']:.2f} ms | "
                 f"{row['of_socket_copy']:.1f}x | {row['of_memory_copy']:.1f}x"
                 if "of_socket_copy" in row else "- | - | - | -")
        print(f"| {row['clients']:.0f} | {row['traced_per_frame']:.2f} | "
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
    parser.add_argument("--rounds", type=int, default=1, help="medians of so many")
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
