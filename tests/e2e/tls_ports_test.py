# SPDX-License-Identifier: Apache-2.0
"""Encryption of both ports, seen by viewloom's command line and by clients that know nothing of
viewloom: Python's ssl, http.client and grpc. Arguments: viewloomd, viewloom."""
import base64
import http.client
import os
import re
import socket
import ssl
import time
import unittest

import grpc

from tls_case import PATIENCE_S, TWO_NAMES, TlsCase, fingerprint_of, run
import viewloomd


class Tls(TlsCase):
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
        connection.close()
        connection.request("GET", "@evil.example/")  # "https://localhost:PORT@evil.example/"
        self.assertEqual(connection.getresponse().status, 400)

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


if __name__ == "__main__":
    unittest.main()
