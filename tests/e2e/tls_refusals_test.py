# SPDX-License-Identifier: Apache-2.0
"""Servers, clients and settings that encryption keeps apart, each with one sentence that says why.
Arguments: viewloomd, viewloom."""
import http.client
import json
import pathlib
import ssl
import threading
import unittest
import urllib.parse

import grpc

from tls_case import CLIENT, TWO_NAMES, TlsCase, fingerprint_of, run
import viewloomd


class TlsRefusals(TlsCase):
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

    # Certificates of clients.

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

    def test_web_clients_count_by_their_certificate(self):
        self.make(*TWO_NAMES)
        own = self.make_clients("lab")
        server = self.serve("--tls.client_ca", str(self.folder / "lab.crt"), "--memory.budget",
                            "1500000000")
        certificate, key = (pathlib.Path(file).read_bytes() for file in own)
        trusted = grpc.ssl_channel_credentials(self.certificate.read_bytes(), key, certificate)
        held = threading.Event()

        def settings():
            yield b"\x0a\x03\x0a\x01s"  # PublishFramesRequest: settings, with the stream "s"
            held.wait()

        with grpc.secure_channel(f"localhost:{self.ports(server)[0]}", trusted) as channel:
            call = channel.stream_stream("/viewloom.v1.IngestService/PublishFrames")(settings())
            next(call)
            display = {"quilt": {"columns": 4, "rows": 4, "size": {"width": 16384,
                                                                   "height": 16384}}}
            target = "/still/s.jpg?display=" + urllib.parse.quote(json.dumps(display))
            status, text = self.get(server, target, *own)
            self.assertEqual(status, 302, text)  # to the name that says the layout
            status, text = self.get(server, text.split()[1], *own)
            held.set()
        self.assertEqual(status, 503, text)
        self.assertIn("left for CN=publisher-1", text)

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
