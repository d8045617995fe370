# SPDX-License-Identifier: Apache-2.0
"""The server under test as a process, on ports of its choice."""

import os
import re
import subprocess
import sys

PATIENCE_S = 120
PROGRAM = sys.argv.pop(1)


class Viewloomd:
    def __init__(self, address="127.0.0.1:0", options=(), log=None, environment=None,
                 http_address="127.0.0.1:0"):
        """options: further ones of `viewloomd serve`. log: a file for what it logs. environment:
        variables beside those of this process."""
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "--grpc.address", address, "--http.address", http_address,
             *options], stdout=subprocess.PIPE, stderr=log, text=True,
            env={**os.environ, **(environment or {})})
        line = self.process.stdout.readline()
        self.address, self.url = re.search(r"grpc=(\S+) http=(\S+)", line).groups()

    def kill(self):
        """As a crash, or a machine that loses its power."""
        self.process.kill()
        self.process.wait(PATIENCE_S)
        self.process.stdout.close()

    def stop(self):
        self.process.terminate()
        code = self.process.wait(PATIENCE_S)
        self.process.stdout.close()
        assert code == 0, f"the server ended with {code}"
