# SPDX-License-Identifier: Apache-2.0
"""Lists of the server that a document started: over TLS and with a token where it wants them."""

import http.client
import json
import ssl
import subprocess
import urllib.request

from endless import value_of

ADDRESS = "127.0.0.1:8080"
PATIENCE_S = 5


class ServerLists:
    def __init__(self, workplace):
        self._workplace = workplace
        self.forget()

    def forget(self):
        """The next server has neither TLS nor tokens, unless learn() says so."""
        self._scheme, self._token = "http", ""

    def learn(self, words):
        """From the words of `viewloomd serve`. A token file gets a token for the tests."""
        self.forget()
        if value_of(words, "--tls.certificate"):
            self._scheme = "https"
        tokens = value_of(words, "--access.token_file")
        if tokens:
            self._token = subprocess.run(
                [self._workplace.viewloomd, "token", "add", "tests", "--role", "watch",
                 "--access.token_file", tokens], cwd=self._workplace.folder(), check=True,
                capture_output=True, text=True,
                env=self._workplace.environment()).stdout.strip()

    def read(self, what):
        """Nothing while the server starts or ends: it may hang up before its answer."""
        headers = {"Authorization": f"Bearer {self._token}"} if self._token else {}
        request = urllib.request.Request(f"{self._scheme}://{ADDRESS}/api/{what}",
                                         headers=headers)
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S, context=context) as answer:
                return json.load(answer)[what]
        except (OSError, http.client.HTTPException, json.JSONDecodeError):
            return []
