# SPDX-License-Identifier: Apache-2.0
"""The server under attack, as a process, and what an attack costs it."""

import contextlib
import json
import os
import re
import resource
import socket
import ssl
import subprocess
import sys
import time
import urllib.request
from dataclasses import dataclass, field
from pathlib import Path

PATIENCE_S = 60
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


class Meter:
    """Memory and CPU time of processes."""

    def __init__(self, *pids):
        self.pids = pids

    def start(self):
        for pid in self.pids:
            with contextlib.suppress(OSError):
                Path(f"/proc/{pid}/clear_refs").write_text("5")  # the peak begins anew
        self.begun_s = time.monotonic()
        self.rss_before_mib = self._status("VmRSS")
        self.cpu_before_s = self.cpu_s()

    def cpu_s(self):
        total = 0
        for pid in self.pids:
            words = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
            total += int(words[11]) + int(words[12])
        return total / TICKS_PER_S

    def _status(self, name):
        text = "".join(Path(f"/proc/{pid}/status").read_text() for pid in self.pids)
        return sum(int(size) for size in re.findall(name + r":\s+(\d+) kB", text)) / 1024

    def peak_growth_mib(self):
        return max(0.0, self._status("VmHWM") - self.rss_before_mib)

    def used_cpu_s(self):
        return self.cpu_s() - self.cpu_before_s


@dataclass(frozen=True)
class Address:
    """Where an attack goes: to the server itself, or to a front before it."""
    grpc_port: int
    http_port: int
    tls: ssl.SSLContext = None
    certificate: bytes = b""
    web_path: str = ""  # before the paths of the server
    host: str = "127.0.0.1"

    def connect(self, port=None, protocols=("h2",)):
        """A connection to the gRPC port, unless another is given."""
        plain = socket.create_connection((self.host, port or self.grpc_port), 5)
        if self.tls is None:
            return plain
        context = ssl.create_default_context(cadata=self.certificate.decode())
        context.check_hostname = False
        context.set_alpn_protocols(list(protocols))
        return context.wrap_socket(plain, server_hostname="localhost")

    def channel(self, **options):
        import grpc  # takes a while: only where it is needed
        address = f"localhost:{self.grpc_port}" if self.tls else f"{self.host}:{self.grpc_port}"
        words = list({"grpc.use_local_subchannel_pool": 1, **options}.items())
        if self.tls is None:
            return grpc.insecure_channel(address, words)
        return grpc.secure_channel(
            address, grpc.ssl_channel_credentials(self.certificate), words)


@dataclass
class Server:
    """viewloomd on free ports. descriptor_max: the limit of its open files. warms_up: it compiles
    kernels after its start. environment: variables beside those of this process."""
    program: str
    descriptor_max: int = 1024
    settings: tuple = ()
    warms_up: bool = False
    environment: dict = field(default_factory=dict)
    process: subprocess.Popen = field(init=False)
    address: Address = field(init=False)

    def __enter__(self):
        limit = (self.descriptor_max, self.descriptor_max)
        self.process = subprocess.Popen(
            [self.program, "serve", "--grpc.address", "127.0.0.1:0", "--http.address",
             "127.0.0.1:0", "--pipeline.warm_up", str(self.warms_up).lower(), *self.settings],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            env={**os.environ, **self.environment},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, limit))
        line = self.process.stdout.readline()
        ports = re.search(r"grpc=\S+:(\d+) http=\S+:(\d+)/", line)
        self.address = Address(*map(int, ports.groups()))
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.process.stdout.close()

    def is_alive(self):
        return self.process.poll() is None


class HealthyPair:
    """healthy_pair.py as a process. token: who it is, if the server asks. options: of the script,
    such as "--rate", "20"."""

    def __init__(self, address, token="", options=()):
        script = Path(__file__).with_name("healthy_pair.py")
        self.process = subprocess.Popen(
            [sys.executable, str(script), f"127.0.0.1:{address.grpc_port}", *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            env={**os.environ, "VIEWLOOM_TOKEN": token})
        if self.process.stdout.readline().strip() != "ready":
            raise RuntimeError("the healthy pair got no picture")

    def take_count(self):
        """What happened since the last call."""
        self.process.stdin.write("count\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def stop(self):
        self.process.stdin.close()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()


def health(address, timeout_s=3):
    """The status of /healthz; None without an answer."""
    try:
        url = f"http://127.0.0.1:{address.http_port}/healthz"
        with urllib.request.urlopen(url, timeout=timeout_s) as reply:
            return reply.status
    except urllib.error.HTTPError as error:
        return error.code
    except OSError:
        return None
