# SPDX-License-Identifier: Apache-2.0
"""viewloomd above the layer, as a process."""

import os
import re
import subprocess
import tempfile
import threading
import time

from board import FaultBoard

PATIENCE_S = 60


class FaultedServer:
    """Starts at once. `address` is None where it ended before it listened. Thread-safety: none."""

    def __init__(self, program, layer_folder, prepare=None, warms_up=False, settings=()):
        """prepare: called with the board before the start."""
        self.board = FaultBoard()
        if prepare:
            prepare(self.board)
        self._log = tempfile.TemporaryFile("w+", encoding="utf-8")
        self.process = subprocess.Popen(
            [program, "serve", "--grpc.address", "127.0.0.1:0", "--http.address", "127.0.0.1:0",
             "--pipeline.warm_up", "true" if warms_up else "false", *settings],
            stdout=subprocess.PIPE, stderr=self._log, text=True, pass_fds=[self.board.file],
            env={**os.environ, **self.board.environment(layer_folder)})
        self.ended_s = None
        self._ending = threading.Thread(target=self._note_end, daemon=True)
        self._ending.start()
        found = re.search(r"grpc=(\S+) ", self.process.stdout.readline())
        self.address = found[1] if found else None
        if self.address:
            self.board.check()

    def _note_end(self):
        self.process.wait()
        self.ended_s = time.monotonic()

    def is_alive(self):
        return self.process.poll() is None

    def wait(self, seconds=PATIENCE_S):
        """The exit code; None where it has not ended by then."""
        self._ending.join(seconds)
        return None if self._ending.is_alive() else self.process.returncode

    def log(self):
        self._log.seek(0)
        return self._log.read()

    def close(self):
        if self.is_alive():
            self.process.kill()
        self._ending.join()
        self.process.stdout.close()
        self._log.close()
        self.board.close()
