# SPDX-License-Identifier: Apache-2.0
"""Addresses that a server and `viewloom list` print: a browser can open each of them. Arguments:
viewloomd-without-engines, viewloom."""
import json
import re
import subprocess
import sys
import unittest
import urllib.request

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
PATIENCE_S = viewloomd.PATIENCE_S
ANY = {"options": ["--open"], "http_address": "0.0.0.0:0"}


class PageAddress(unittest.TestCase):
    def serve(self, **settings):
        server = viewloomd.Viewloomd(**settings)
        self.addCleanup(server.stop)
        return server

    def page_of(self, server):
        listed = subprocess.run([CLIENT, "--server", server, "list", "server"], check=True,
                                capture_output=True, text=True, timeout=PATIENCE_S).stdout
        return re.search(r"^page: (.*)$", listed, re.MULTILINE).group(1)

    def check_opens(self, url):
        self.assertNotRegex(url, r"//(0\.0\.0\.0|\[::\])")
        with urllib.request.urlopen(url, timeout=PATIENCE_S) as reply:
            self.assertEqual(reply.status, 200)

    def test_the_start_line_has_a_page_to_open(self):
        self.check_opens(self.serve(**ANY).url)

    def test_list_says_the_page_at_the_host_that_was_reached(self):
        port = self.serve(**ANY, address="0.0.0.0:0").address.rsplit(":", 1)[1]
        for host in ("127.0.0.1", "localhost", "127.0.0.2", "0.0.0.0"):
            with self.subTest(host):
                page = self.page_of(f"{host}:{port}")
                shown = "localhost" if host == "0.0.0.0" else host
                self.assertTrue(page.startswith(f"http://{shown}:"), page)
                self.check_opens(page)

    def test_json_has_the_same_page(self):
        server = self.serve(**ANY)
        listed = subprocess.run([CLIENT, "--server", server.address, "list", "server", "--json"],
                                check=True, capture_output=True, text=True,
                                timeout=PATIENCE_S).stdout
        address = json.loads(listed)
        self.check_opens(address.get("httpAddress") or address["http_address"])

    def test_a_page_of_one_address_stays_as_it_is(self):
        server = self.serve()
        self.assertEqual(self.page_of(server.address), server.url)


if __name__ == "__main__":
    unittest.main()
