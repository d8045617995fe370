# SPDX-License-Identifier: Apache-2.0
"""More connections than a server can hold, and requests that never end."""

import contextlib
import socket
import sys
import time
import urllib.error
import urllib.request

import target

# Within which a call is answered after the flood; in the short form, other tests may run.
CALL_S, SHORT_CALL_S = 1.0, 3.0


def hold(port, count, is_over, first_bytes=b""):
    """Connections that send no more than that."""
    held = []
    for _ in range(count):
        if is_over():
            break
        try:
            one = socket.create_connection(("127.0.0.1", port), 2)
            held.append(one)
            one.sendall(first_bytes)
        except OSError:
            continue
    return held


def close(held):
    for one in held:
        with contextlib.suppress(OSError):
            one.close()


def call_takes_s(address, timeout_s=5):
    """How long one call of gRPC takes; None if it fails. Tries again, as clients do."""
    import grpc  # takes a while: only where it is needed
    from viewloom.v1 import catalog_service_pb2, catalog_service_pb2_grpc
    begun = time.monotonic()
    while time.monotonic() < begun + timeout_s:
        with address.channel() as channel:
            stub = catalog_service_pb2_grpc.CatalogServiceStub(channel)
            try:
                stub.GetServerInfo(catalog_service_pb2.GetServerInfoRequest(), timeout=timeout_s)
                return time.monotonic() - begun
            except grpc.RpcError:
                time.sleep(0.05)
    return None


def idle_grpc(address, budget):
    """Idle connections to the gRPC port until files run out, then one call."""
    call_takes_s(address)  # loads the library
    held = hold(address.grpc_port, budget.count(1_500, 9_000), budget.deadline())
    time.sleep(0.3)
    told = target.health(address)
    close(held)
    return found_after_flood(told, call_takes_s(address), target.health(address), budget)


def found_after_flood(health_during, call_s, health_after, budget):
    """What is wrong with these answers. Also judges planted ones."""
    most_s = SHORT_CALL_S if budget.scale == 1 else CALL_S
    found = []
    if call_s is not None:  # beside the table
        print(f"a call of gRPC after the flood took {call_s:.2f} s", file=sys.stderr)
    if health_during not in (200, 503):
        found.append(f"/healthz did not answer during the flood: {health_during}")
    if call_s is None or call_s > most_s:
        found.append(f"the gRPC port took {call_s} s for a call after the flood, at most {most_s}")
    if call_s is None and health_after == 200:
        found.append("/healthz says 200 while the gRPC port is dead")
    return found


def idle_http(address, budget):
    """Idle connections to the web port; one visitor comes meanwhile."""
    held = hold(address.http_port, budget.count(1_500, 9_000), budget.deadline())
    found = found_by_visitors(address, 10)
    close(held)
    return found + found_after_flood(200, call_takes_s(address), target.health(address), budget)


def slowloris(address, budget):
    """Requests of which a byte comes now and then; visitors come meanwhile."""
    is_over = budget.deadline()
    held = hold(address.http_port, budget.count(1_300, 2_600), is_over,
                b"GET / HTTP/1.1\r\nHost: localhost\r\nX-A: ")
    found = found_by_visitors(address, 20)
    while not is_over():
        for one in held:
            with contextlib.suppress(OSError):
                one.sendall(b"a")
        time.sleep(0.2)
    close(held)
    return found


def found_by_visitors(address, count):
    """Each visitor asks for the page, and an operator for health and metrics."""
    found = []
    for path in ("", "healthz", "metrics"):
        served = 0
        for _ in range(count):
            with contextlib.suppress(OSError):
                url = f"http://127.0.0.1:{address.http_port}/{path}"
                with urllib.request.urlopen(url, timeout=3) as reply:
                    served += reply.status == 200
        if served < count * 0.9:
            found.append(f"/{path}: {served} of {count} visitors were served")
    return found


ATTACKS = (idle_grpc, idle_http, slowloris)
