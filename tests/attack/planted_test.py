# SPDX-License-Identifier: Apache-2.0
"""Every detector of the attacks finds a fault that is planted. Argument: viewloomd. PYTHONPATH has
the Python client."""

import contextlib
import http.server
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
from concurrent import futures

import grpc

import budget
import connection_floods
import judge
import measure
import message_floods
import web_floods
from target import Address, HealthyPair, Meter, Server

PROGRAM = sys.argv.pop(1)
STOP_S = 1.5
# Takes 200 MiB and half a second of CPU time when a line comes.
GREEDY = """import sys, time
print("ready", flush=True)
sys.stdin.readline()
taken = bytearray(b"x") * (200 << 20)
end_s = time.process_time() + 0.5
while time.process_time() < end_s:
    pass
print("done", flush=True)
sys.stdin.readline()
"""


def row(**changes):
    values = {"name": "planted", "pictures": 20, "pictures_due": 20.0, "longest_gap_s": 0.1,
              "rest_gap_s": 0.1, "memory_mib": 1.0, "cpu_s": 0.1, **changes}
    return judge.Row(**values)


class PlantedService(grpc.GenericRpcHandler):
    """Answers every call: with a message, or with a status."""

    def __init__(self, status=None):
        self.status = status

    def service(self, _):
        return grpc.stream_stream_rpc_method_handler(self.answer)

    def answer(self, requests, context):
        next(requests)
        if self.status:
            context.abort(self.status, "planted")
        yield b""


@contextlib.contextmanager
def planted_rpc(status=None):
    server = grpc.server(futures.ThreadPoolExecutor(4),
                         options=[("grpc.max_receive_message_length", -1)])
    server.add_generic_rpc_handlers((PlantedService(status),))
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    yield Address(port, 0)
    server.stop(None)


class Trusting(http.server.BaseHTTPRequestHandler):
    """Answers to any name, and to any page."""

    def do_GET(self):
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_):
        pass


class Planted(unittest.TestCase):
    def found(self, a_row, limits=judge.FULL, is_front=False):
        return " ".join(judge.judged(a_row, limits, is_front).found)

    def test_a_row_within_its_limits_is_ok(self):
        self.assertEqual(self.found(row()), "")
        self.assertEqual(self.found(row(), judge.FRONT, True), "")

    def test_each_limit_is_judged(self):
        self.assertIn("pictures: 12 of 20", self.found(row(pictures=12)))
        self.assertIn("lost: 2 pictures", self.found(row(lost=2), judge.FRONT, True))
        self.assertEqual(self.found(row(lost=1), judge.FRONT, True), "")
        self.assertIn("gap: 0.80 s", self.found(row(longest_gap_s=0.8)))
        self.assertIn("memory: 70 MiB", self.found(row(memory_mib=70)))
        self.assertIn("CPU: 9.00 s", self.found(row(cpu_s=9)))
        self.assertIn("memory: 20 MiB", self.found(row(memory_mib=20), judge.FRONT, True))
        self.assertIn("CPU: 0.50 s", self.found(row(cpu_s=0.5), judge.FRONT, True))
        self.assertEqual(self.found(row(found=["said"])), "said")
        self.assertIn("gap", self.found(row(name="rapid_reset", longest_gap_s=6)))
        self.assertIn("memory", self.found(row(name="rapid_reset", memory_mib=700)))

    def test_a_server_that_stops_for_a_while_is_found(self):
        with Server(PROGRAM) as server:
            pair = HealthyPair(server.address)
            self.addCleanup(pair.stop)

            def stop(*_):
                os.kill(server.process.pid, signal.SIGSTOP)
                time.sleep(STOP_S)
                os.kill(server.process.pid, signal.SIGCONT)

            # Rest tells how many pictures are due: of a pair that is well, and for long enough.
            self.assertTrue(measure.is_well(pair))
            a_row = measure.measure(stop, server, pair, Meter(server.process.pid), server.address,
                                    budget.Budget(seconds=2.0, scale=1))
        self.assertIn("gap", self.found(a_row))
        self.assertIn("pictures", self.found(a_row))

    def test_a_pair_that_does_not_recover_is_found(self):
        with Server(PROGRAM) as server:
            pair = HealthyPair(server.address)
            self.addCleanup(pair.stop)
            self.assertTrue(measure.is_well(pair))
            os.kill(server.process.pid, signal.SIGSTOP)
            try:
                self.assertFalse(measure.is_well(pair, patience_s=2))
            finally:
                os.kill(server.process.pid, signal.SIGCONT)

    def test_a_server_that_ends_is_found(self):
        with Server(PROGRAM) as server:
            pair = HealthyPair(server.address)
            self.addCleanup(pair.stop)

            def end(*_):
                server.process.kill()
                server.process.wait()

            a_row = measure.measure(end, server, pair, Meter(server.process.pid), server.address,
                                    budget.SHORT)
        self.assertIn("the server ended", self.found(a_row))

    def test_memory_and_time_of_a_process_are_found(self):
        with subprocess.Popen([sys.executable, "-c", GREEDY], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, text=True) as greedy:
            greedy.stdout.readline()
            meter = Meter(greedy.pid)
            meter.start()
            self.assertLess(meter.peak_growth_mib(), 50)
            greedy.stdin.write("go\n")
            greedy.stdin.flush()
            greedy.stdout.readline()
            self.assertGreater(meter.peak_growth_mib(), 150)
            self.assertGreater(meter.used_cpu_s(), 0.4)
            greedy.stdin.close()

    def test_a_dead_port_behind_a_good_health_is_found(self):
        with socket.create_server(("127.0.0.1", 0)) as deaf:
            address = Address(deaf.getsockname()[1], 0)
            call_s = connection_floods.call_takes_s(address, timeout_s=1)
        found = " ".join(connection_floods.found_after_flood(200, call_s, 200, budget.SHORT))
        self.assertIn("the gRPC port took", found)
        self.assertIn("/healthz says 200", found)
        self.assertIn("did not answer",
                      " ".join(connection_floods.found_after_flood(None, 0.1, 200,
                                                                   budget.LONG)))

    def test_visitors_that_are_not_served_are_found(self):
        with socket.create_server(("127.0.0.1", 0)) as gone:
            port = gone.getsockname()[1]
        self.assertEqual(len(connection_floods.found_by_visitors(Address(0, port), 3)), 3)

    def test_unpacked_messages_are_found(self):
        with planted_rpc() as address:
            found = message_floods.gzip_messages(address, budget.SHORT)
        self.assertIn("was unpacked", " ".join(found))

    def test_a_wrong_status_for_a_long_name_is_found(self):
        with planted_rpc(grpc.StatusCode.RESOURCE_EXHAUSTED) as address:
            found = message_floods.long_names(address, budget.SHORT)
        self.assertIn("RESOURCE_EXHAUSTED instead of NOT_FOUND", " ".join(found))

    def test_a_server_that_trusts_any_name_is_found(self):
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Trusting) as trusting:
            threading.Thread(target=trusting.serve_forever, daemon=True).start()
            address = Address(0, trusting.server_address[1])
            found = web_floods.dns_rebinding(address, budget.SHORT)
            refused = web_floods.broken_json(address, budget.SHORT)
            trusting.shutdown()
        self.assertEqual(len(found), 15)  # each with a reason of its own
        self.assertIn("the WebSocket was refused", refused)


if __name__ == "__main__":
    unittest.main(verbosity=2)
