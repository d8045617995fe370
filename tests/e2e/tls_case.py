# SPDX-License-Identifier: Apache-2.0
"""A server with a certificate of its own, for tests of encryption. Takes the programs viewloomd and
viewloom off the arguments."""
import hashlib
import http.client
import pathlib
import re
import shutil
import ssl
import subprocess
import sys
import tempfile
import unittest

import grpc

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
PATIENCE_S = viewloomd.PATIENCE_S
TWO_NAMES = ("--name", "localhost", "--name", "127.0.0.1")


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=PATIENCE_S)


def openssl(folder, *words):
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)


def fingerprint_of(path):
    der = ssl.PEM_cert_to_DER_cert(path.read_text())
    digits = hashlib.sha256(der).hexdigest().upper()
    return ":".join(digits[i:i + 2] for i in range(0, len(digits), 2))


class TlsCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.certificate = self.folder / "viewloomd.crt"
        self.key = self.folder / "viewloomd.key"
        self.log = self.folder / "log"

    def make(self, *options):
        made = run(viewloomd.PROGRAM, "certificate", "--out", str(self.folder), *options)
        self.assertEqual(made.returncode, 0, made.stderr)
        return made.stdout

    def files(self):
        return ("--tls.certificate", str(self.certificate), "--tls.key", str(self.key))

    def serve(self, *options):
        log = self.log.open("w")
        self.addCleanup(log.close)
        server = viewloomd.Viewloomd(options=(*self.files(), *options), log=log)
        self.addCleanup(server.stop)
        self.assertTrue(server.address.startswith("https://"), server.address)
        self.assertTrue(server.url.startswith("https://"), server.url)
        return server

    def ports(self, server):
        return [int(re.search(r":(\d+)/?$", text).group(1))
                for text in (server.address, server.url)]

    def context(self, *own):
        context = ssl.create_default_context(cafile=self.certificate)
        if own:
            context.load_cert_chain(*own)
        return context

    def get(self, server, path, *own):
        connection = http.client.HTTPSConnection("localhost", self.ports(server)[1],
                                                 context=self.context(*own), timeout=PATIENCE_S)
        self.addCleanup(connection.close)
        connection.request("GET", path)
        answer = connection.getresponse()
        return answer.status, answer.read().decode()

    def streams(self, server, credentials):
        """What a foreign client gets of ListStreams; none are there, so that it is empty."""
        with grpc.secure_channel(f"localhost:{self.ports(server)[0]}", credentials) as channel:
            call = channel.unary_unary("/viewloom.v1.CatalogService/ListStreams")
            return call(b"", timeout=10)

    def list(self, server, *options):
        return run(CLIENT, "list", "server", "--server", server.address, *options)

    def shown(self, port):
        """Fingerprint of the certificate that a port shows."""
        der = ssl.PEM_cert_to_DER_cert(ssl.get_server_certificate(("localhost", port)))
        return hashlib.sha256(der).hexdigest()

    def make_clients(self, name):
        """An authority and a client of it."""
        elliptic = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-noenc")
        (self.folder / "client.ext").write_text("extendedKeyUsage = clientAuth\n")
        openssl(self.folder, "req", "-x509", *elliptic, "-subj", f"/CN={name}", "-keyout",
                f"{name}.key", "-out", f"{name}.crt")
        openssl(self.folder, "req", *elliptic, "-subj", "/CN=publisher-1", "-keyout",
                f"{name}-client.key", "-out", "client.csr")
        openssl(self.folder, "x509", "-req", "-in", "client.csr", "-CA", f"{name}.crt", "-CAkey",
                f"{name}.key", "-CAcreateserial", "-extfile", "client.ext", "-out",
                f"{name}-client.crt")
        return [str(self.folder / f"{name}-client.{end}") for end in ("crt", "key")]
