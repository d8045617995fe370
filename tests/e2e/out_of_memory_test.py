# SPDX-License-Identifier: Apache-2.0
"""A server whose allocations fail again and again refuses requests, goes on, and serves everybody
once there is memory again. Arguments: viewloomd, viewloom, the library that lets them fail."""
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
LIBRARY = sys.argv.pop(1)
WITHOUT_MEMORY_S = 8


class OutOfMemory(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.switch = pathlib.Path(folder.name) / "no memory"
        self.server = viewloomd.Viewloomd(
            options=["--pipeline.warm_up", "false"],
            environment={"LD_PRELOAD": LIBRARY, "VIEWLOOM_FAILING_NEW": str(self.switch)})
        self.addCleanup(self.server.stop)

    def start_publishing(self, seconds):
        return subprocess.Popen(
            [CLIENT, "--server", self.server.address, "publish", "--synthetic", "--size", "640x360",
             "--layers", "2", "--fps", "10", "--seconds", str(seconds), "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def publish(self):
        self.assertEqual(self.start_publishing(1).wait(viewloomd.PATIENCE_S), 0)

    def fetch(self, path):
        try:
            with urllib.request.urlopen(self.server.url + path,
                                        timeout=viewloomd.PATIENCE_S) as reply:
                return reply.read()
        except OSError as error:
            return error

    def test_goes_on_without_memory(self):
        self.publish()
        self.switch.touch()
        give_up = time.monotonic() + WITHOUT_MEMORY_S
        while time.monotonic() < give_up:
            publishing = self.start_publishing(2)
            self.fetch("still/demo/portrait")
            self.fetch("api/streams")
            publishing.terminate()
            publishing.wait(viewloomd.PATIENCE_S)
            self.assertIsNone(self.server.process.poll(), "the server has ended")
        self.switch.unlink()
        self.publish()
        still = self.fetch("still/demo/portrait")
        self.assertIsInstance(still, bytes, still)
        self.assertTrue(still.startswith(b"\xff\xd8"))


if __name__ == "__main__":
    unittest.main()
