# SPDX-License-Identifier: Apache-2.0
"""A front with the reference configuration before a server, on loopback, with a certificate of its
own."""

import os
import re
import shutil
import socket
import ssl
import subprocess
import tempfile
import time
from pathlib import Path

from target import Address, PATIENCE_S

KINDS = ("haproxy", "nginx")
HOST = "viewloom.example"  # as the configurations name it
SETTINGS = ("--http.allowed_hosts", HOST)
SKIPPED = 77  # an exit code that ctest knows
DEPLOY = Path(__file__).parents[2] / "deploy"


def program_of(kind):
    """Where it is; None if it is not installed."""
    return os.environ.get(f"VIEWLOOM_{kind.upper()}") or shutil.which(
        kind, path=os.environ["PATH"] + ":/usr/sbin")


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def make_certificate(folder):
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
         "-nodes", "-days", "2", "-subj", f"/CN={HOST}", "-keyout", folder / "front.key", "-out",
         folder / "front.crt", "-addext",
         f"subjectAltName=DNS:{HOST},DNS:localhost,IP:127.0.0.1"],
        check=True, capture_output=True)
    certificate = (folder / "front.crt").read_bytes()
    (folder / "front.pem").write_bytes(certificate + (folder / "front.key").read_bytes())
    return certificate


def replaced(text, changes):
    """Each change has to be possible: the configuration is tested, not a copy of it."""
    for pattern, replacement in changes:
        text, count = re.subn(pattern, replacement, text, flags=re.MULTILINE)
        if count == 0:
            raise RuntimeError(f"the configuration has no {pattern}")
    return text


class Front:
    def __init__(self, kind, behind):
        self.folder = tempfile.TemporaryDirectory()
        folder = Path(self.folder.name)
        certificate = make_certificate(folder)
        self.port = free_port()
        ports = [(r"127\.0\.0\.1:50051", f"127.0.0.1:{behind.grpc_port}"),
                 (r"127\.0\.0\.1:8080", f"127.0.0.1:{behind.http_port}"),
                 (r"/etc/viewloom/", f"{folder}/"),
                 # The attacks and the pair come from one address, under this name too.
                 (r"viewloom\.example", f"{HOST} localhost")]
        command = self.haproxy(folder, ports) if kind == "haproxy" else self.nginx(folder, ports)
        with open(folder / "output.log", "wb") as output:
            self.process = subprocess.Popen([program_of(kind), *map(str, command)], stdout=output,
                                            stderr=output)
        self.address = Address(self.port, self.port, ssl.create_default_context(), certificate,
                               "/viewloom", host="127.0.0.1")

    def haproxy(self, folder, ports):
        text = (DEPLOY / "haproxy.cfg").read_text()
        changes = ports + [(r"^    bind :443 ", f"    bind 127.0.0.1:{self.port} "),
                           # Only root can become another user.
                           (r"^    (user|group|chroot) .*\n", "")]
        (folder / "haproxy.cfg").write_text(replaced(text, changes))
        return ["-db", "-f", folder / "haproxy.cfg"]

    def nginx(self, folder, ports):
        text = (DEPLOY / "nginx.conf").read_text()
        changes = ports + [(r"listen 443 ", f"listen 127.0.0.1:{self.port} ")]
        (folder / "site.conf").write_text(replaced(text, changes))
        paths = "".join(f"    {name}_temp_path {folder}/{name};\n" for name in
                        ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        # Debian's nginx.conf logs each request, unless a site says otherwise.
        (folder / "nginx.conf").write_text(
            f"daemon off;\nmaster_process off;\npid {folder}/pid;\nerror_log {folder}/error.log;\n"
            f"events {{}}\nhttp {{\n    access_log {folder}/access.log;\n"
            f"{paths}    include {folder}/site.conf;\n}}\n")
        return ["-p", folder, "-c", folder / "nginx.conf", "-e", folder / "error.log"]

    def logged(self):
        return "".join(log.read_text() for log in Path(self.folder.name).glob("*.log"))

    def pids(self):
        return [self.process.pid]

    def __enter__(self):
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline and self.process.poll() is None:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return self
            except OSError:
                time.sleep(0.05)
        raise RuntimeError("the front did not start")

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(PATIENCE_S)
        self.folder.cleanup()
