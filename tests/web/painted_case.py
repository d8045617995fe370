# SPDX-License-Identifier: Apache-2.0
"""Tests of one painted server, which is to end well."""
import unittest

from web_client import Server


class PaintedCase(unittest.TestCase):
    """The tests of a class share a server. PROGRAM of the class: the painted server's."""

    PROGRAM = ""

    @classmethod
    def setUpClass(cls):
        cls.server = Server(cls.PROGRAM, "--timeout-ms", 3000)
        cls.port = cls.server.port

    @classmethod
    def tearDownClass(cls):
        with cls.server:
            code = cls.server.stop()
            assert code == 0, f"the server ended with {code}"
