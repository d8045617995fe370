# SPDX-License-Identifier: Apache-2.0
"""Encryption of both ports, seen by viewloom's command line and by clients that know nothing of
viewloom: Python's ssl, http.client and grpc. Arguments: viewloomd, viewloom."""
import base64
import hashlib
import http.client
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import time
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


class Tls(unittest.TestCase):
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

    # Making a certificate.

    def test_a_certificate_is_made_for_its_owner_alone(self):
        said = self.make(*TWO_NAMES, "--days", "30")
        self.assertIn("for localhost, 127.0.0.1, until ", said)
        self.assertIn(f"SHA-256 fingerprint {fingerprint_of(self.certificate)}", said)
        self.assertEqual(os.stat(self.key).st_mode & 0o777, 0o600)
        before = self.key.read_text()
        again = run(viewloomd.PROGRAM, "certificate", "--out", str(self.folder), *TWO_NAMES)
        self.assertEqual(again.returncode, 1)
        self.assertIn("is there already; replace it with --replace", again.stderr)
        self.assertEqual(self.key.read_text(), before)
        self.make("--replace", *TWO_NAMES)
        self.assertNotEqual(self.key.read_text(), before)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["viewloomd.crt", "viewloomd.key"])

    def test_a_certificate_is_made_for_this_machine(self):
        self.assertIn("localhost", self.make())

    # Both ports.

    def test_both_ports_speak_tls_1_2_and_1_3_alone(self):
        self.make(*TWO_NAMES)
        for port in self.ports(self.serve()):
            for version, name in ((ssl.TLSVersion.TLSv1_1, None),
                                  (ssl.TLSVersion.TLSv1_2, "TLSv1.2"),
                                  (ssl.TLSVersion.TLSv1_3, "TLSv1.3")):
                context = self.context()
                context.set_ciphers("ALL:@SECLEVEL=0")
                context.set_alpn_protocols(["h2", "http/1.1"])
                context.minimum_version = version
                context.maximum_version = version
                with socket.create_connection(("localhost", port), PATIENCE_S) as plain:
                    if name is None:
                        with self.assertRaises((ssl.SSLError, ConnectionError)):
                            context.wrap_socket(plain, server_hostname="localhost")
                        continue
                    with context.wrap_socket(plain, server_hostname="localhost") as secured:
                        self.assertEqual(secured.version(), name)

    def test_foreign_clients_are_served(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        trusted = grpc.ssl_channel_credentials(self.certificate.read_bytes())
        self.assertEqual(self.streams(server, trusted), b"")
        self.assertEqual(self.get(server, "/healthz"), (200, "serving\n"))
        status, metrics = self.get(server, "/metrics")
        self.assertEqual(status, 200)
        end_s = float(re.search(r"^viewloom_certificate_end_seconds (\S+)$", metrics,
                                re.MULTILINE).group(1))
        self.assertAlmostEqual(end_s, time.time() + 825 * 86400, delta=86400)
        with self.assertRaises(grpc.RpcError):
            self.streams(server, grpc.ssl_channel_credentials())

    def test_web_sockets_open_over_tls(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        key = base64.b64encode(os.urandom(16)).decode()
        port = self.ports(server)[1]
        with socket.create_connection(("localhost", port), PATIENCE_S) as plain, \
                self.context().wrap_socket(plain, server_hostname="localhost") as secured:
            secured.sendall(
                f"GET /ws?stream=none&preset=portrait HTTP/1.1\r\nHost: localhost:{port}\r\n"
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                f"Sec-WebSocket-Key: {key}\r\nOrigin: https://localhost:{port}\r\n\r\n".encode())
            # There is no such stream, and the answer says so: the request was read and judged.
            self.assertIn(b"404", secured.recv(4096).split(b"\r\n")[0])

    def test_a_request_without_tls_is_sent_to_https(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        port = self.ports(server)[1]
        connection = http.client.HTTPConnection("localhost", port, timeout=PATIENCE_S)
        self.addCleanup(connection.close)
        connection.request("GET", "/api/streams?x=1")
        answer = connection.getresponse()
        self.assertEqual(answer.status, 302)
        self.assertEqual(answer.headers["Location"], f"https://localhost:{port}/api/streams?x=1")
        connection.close()
        connection.request("GET", "/", headers={"Host": "evil.example"})
        self.assertEqual(connection.getresponse().status, 403)

    # viewloom's command line.

    def test_the_command_line_pins_or_trusts(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        for options in (("--fingerprint", fingerprint_of(self.certificate)),
                        ("--tls-ca", str(self.certificate))):
            listed = self.list(server, *options)
            self.assertEqual(listed.returncode, 0, listed.stderr)
            self.assertIn("reach: this machine alone", listed.stdout)

    def test_the_command_line_says_why_it_refuses_a_server(self):
        self.make("--name", "studio.local")
        server = self.serve()
        for options, words in (
                (("--fingerprint", 32 * "00"), "is not the pinned one"),
                (("--tls-ca", str(self.certificate)), "is made for studio.local"),
                ((), "self-signed certificate; name the certificate of its authority")):
            listed = self.list(server, *options)
            self.assertNotEqual(listed.returncode, 0)
            self.assertIn(words, listed.stderr)
            self.assertEqual(listed.stderr.count("\n"), 1)

    def test_the_command_line_wants_https_for_its_options(self):
        refused = run(CLIENT, "list", "--server", "localhost:1", "--fingerprint", 32 * "00")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("write it as https://HOST:PORT", refused.stderr)
        self.make(*TWO_NAMES)
        server = self.serve()
        plain = run(CLIENT, "list", "--server", server.address.removeprefix("https://"))
        self.assertIn("if it speaks TLS, write its address as https://HOST:PORT", plain.stderr)

    # Other files while the server runs.

    def wait_for(self, condition):
        end_s = time.monotonic() + PATIENCE_S
        while not condition() and time.monotonic() < end_s:
            time.sleep(0.2)
        self.assertTrue(condition())

    def test_changed_files_are_taken_without_a_restart(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        first = self.shown(self.ports(server)[0])
        self.make("--replace", *TWO_NAMES)
        for port in self.ports(server):
            self.wait_for(lambda port=port: self.shown(port) != first)
        self.assertIn("new connections get the changed certificate", self.log.read_text())
        self.assertIn('viewloom_certificate_changes_total{outcome="taken"} 1',
                      self.get(server, "/metrics")[1])

    def test_bad_files_leave_the_certificate_as_it_was(self):
        self.make(*TWO_NAMES)
        server = self.serve()
        first = self.shown(self.ports(server)[0])
        certificate = self.certificate.read_text()
        self.certificate.write_text("nothing")
        self.wait_for(lambda: "is not used, and the one before stays" in self.log.read_text())
        self.assertEqual([self.shown(port) for port in self.ports(server)], [first, first])
        self.assertNotIn("PRIVATE", self.log.read_text())
        self.certificate.write_text(certificate)
        self.assertIn('viewloom_certificate_changes_total{outcome="refused"} 1',
                      self.get(server, "/metrics")[1])

    # Certificates of clients.

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

    def test_clients_need_a_certificate_of_the_authority(self):
        self.make(*TWO_NAMES)
        own = self.make_clients("lab")
        other = self.make_clients("other")
        server = self.serve("--tls.client_ca", str(self.folder / "lab.crt"))
        pin = ("--fingerprint", fingerprint_of(self.certificate))
        listed = self.list(server, *pin, "--tls-cert", own[0], "--tls-key", own[1])
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.assertEqual(self.get(server, "/healthz", *own)[0], 200)
        self.assertIn("--tls-cert", self.list(server, *pin).stderr)
        self.assertNotEqual(self.list(server, *pin, "--tls-cert", other[0], "--tls-key",
                                      other[1]).returncode, 0)
        for wrong in ((), other):
            with self.assertRaises((ssl.SSLError, OSError, http.client.HTTPException)):
                self.get(server, "/healthz", *wrong)

    def test_clients_may_do_without_where_the_server_says_so(self):
        self.make(*TWO_NAMES)
        own = self.make_clients("lab")
        server = self.serve("--tls.client_ca", str(self.folder / "lab.crt"),
                            "--tls.client_required", "false")
        self.assertEqual(self.get(server, "/healthz")[0], 200)
        self.assertEqual(self.get(server, "/healthz", *own)[0], 200)

    # Before the server listens.

    def refusal(self, *options):
        refused = run(viewloomd.PROGRAM, "serve", "--http.address", "127.0.0.1:0", *options)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertNotIn("listening", refused.stdout)
        self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)
        return refused.stderr

    def test_wrong_files_end_the_start_in_one_sentence(self):
        self.make(*TWO_NAMES)
        address = ("--grpc.address", "127.0.0.1:0")
        certificate = ("--tls.certificate", str(self.certificate))
        self.assertIn("tls.key is missing", self.refusal(*address, *certificate))
        self.assertIn("No such file", self.refusal(*address, *certificate, "--tls.key", "/none"))
        self.assertIn("holds no private key",
                      self.refusal(*address, *certificate, "--tls.key", str(self.certificate)))
        own = self.make_clients("lab")
        self.assertIn("does not belong to the certificate",
                      self.refusal(*address, *certificate, "--tls.key", own[1]))
        self.assertIn("not made for a server",
                      self.refusal(*address, "--tls.certificate", own[0], "--tls.key", own[1]))
        self.assertIn("tls.client_ca", self.refusal(*address, *self.files(), "--tls.client_ca",
                                                    str(self.key)))

    def test_an_unprotected_server_stays_on_its_machine(self):
        self.make(*TWO_NAMES)
        refusal = self.refusal("--grpc.address", "0.0.0.0:0")
        self.assertIn("0.0.0.0:0 is open to the network without encryption", refusal)
        self.assertIn("--open", refusal)
        self.assertIn("without access control",
                      self.refusal("--grpc.address", "0.0.0.0:0", *self.files()))


if __name__ == "__main__":
    unittest.main()
