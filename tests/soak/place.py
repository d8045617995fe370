# SPDX-License-Identifier: Apache-2.0
"""The server under test, as clients know it: plain, or with encryption and access tokens."""

import contextlib
import dataclasses
import os
import ssl
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import target
import viewloom

# Blocks that a thread keeps for its next use count as lent. Without them, the same load leaves the
# same number behind.
ENVIRONMENT = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0"}
NAME = "soak"


@dataclass
class Place:
    """Thread-safety: methods may be called from any thread."""
    address: target.Address
    pid: int
    metadata: tuple = ()  # of each call, and of each request over HTTP
    token: str = ""
    authorities: Path = None  # a file in PEM; None = no encryption

    def connect(self, token=None):
        """The Python client."""
        shown = self.token if token is None else token
        if self.authorities is None:
            return viewloom.connect(f"127.0.0.1:{self.address.grpc_port}", reconnect=False,
                                    token=shown)
        return viewloom.connect(f"https://localhost:{self.address.grpc_port}", reconnect=False,
                                token=shown, tls=viewloom.Tls(ca=self.authorities))

    def web(self):
        """A connection to the web port."""
        return self.address.connect(self.address.http_port, ("http/1.1",))


class Protection:
    """Certificates and tokens in a folder of their own, which change while the server runs."""

    def __init__(self, program):
        self.program = program
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        self.tokens = self.path / "tokens.jsonl"
        self.pairs = [self._make_pair(name) for name in ("first", "second")]
        self.authorities = self.path / "authorities.pem"
        self.authorities.write_bytes(b"".join(pair[0] for pair in self.pairs))
        self.use(self.pairs[0])
        self.token = self.add("watching", "publish,watch,operate")

    def _run(self, *words):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True,
                              check=True, timeout=target.PATIENCE_S)
        return done.stdout.strip()

    def _make_pair(self, name):
        out = self.path / name
        out.mkdir()
        self._run("certificate", "--out", out, "--name", "localhost", "--name", "127.0.0.1")
        return [(out / f"viewloomd.{end}").read_bytes() for end in ("crt", "key")]

    def files(self):
        return [self.path / "server.crt", self.path / "server.key"]

    def use(self, pair):
        """Replaces both files of the certificate."""
        for file, content in zip(self.files(), pair):
            replace(file, content)

    def add(self, name, role):
        """A new token."""
        return self._run("token", "add", name, "--role", role, "--access.token_file", self.tokens)

    def revoke(self, name):
        self._run("token", "revoke", name, "--access.token_file", self.tokens)

    def settings(self):
        certificate, key = self.files()
        return ("--tls.certificate", str(certificate), "--tls.key", str(key),
                "--access.token_file", str(self.tokens),
                "--access.audit_file", str(self.path / "audit.jsonl"))

    def place(self, server):
        context = ssl.create_default_context(cafile=self.authorities)
        address = dataclasses.replace(server.address, tls=context,
                                      certificate=self.authorities.read_bytes())
        return Place(address, server.process.pid, (("authorization", f"Bearer {self.token}"),),
                     self.token, self.authorities)

    def close(self):
        self.folder.cleanup()


def replace(file, content):
    """In one step: a reader gets the old content or the new one."""
    new = file.with_suffix(".new")
    new.write_bytes(content)
    new.chmod(0o600)
    os.replace(new, file)


@contextlib.contextmanager
def served(program, protection=None, environment=None):
    """A server, and how clients reach it."""
    # Without core dumps, the system does not tell what files the server has open.
    settings = ("--containment.core_dumps", "true", *(protection.settings() if protection else ()))
    with target.Server(program, settings=settings,
                       environment={**ENVIRONMENT, **(environment or {})}) as server:
        place = protection.place(server) if protection else Place(server.address,
                                                                  server.process.pid)
        yield server, place
