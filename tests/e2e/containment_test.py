# SPDX-License-Identifier: Apache-2.0
"""A contained server makes pictures of all kinds and is refused nothing that it needs. Its log, its
answers and the kernel say what holds. Arguments: viewloomd, viewloom."""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
# One for each way to make a picture: swept rows, walked rays, a lens, both layers.
SIZE = {"width": 48, "height": 36}
DISPLAYS = ({"quilt": {"columns": 2, "rows": 2, "size": {"width": 96, "height": 72}}},
            {"stereo": {"eyeSize": SIZE}},
            {"integral": {"preset": "near_eye_2013", "panelSize": SIZE}},
            {"rgbd": {"viewSize": SIZE, "form": "RGBD_FORM_TWO_LAYERS"}})


class Containment(unittest.TestCase):
    def serve(self, *more, address="127.0.0.1:0"):
        """A server whose log is in self.log."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = pathlib.Path(folder.name) / "log"
        with self.log.open("wb") as errors:
            server = viewloomd.Viewloomd(address, more, errors)
        self.addCleanup(server.stop)
        if "containment is off" in self.log.read_text(encoding="utf-8") and not more:
            self.skipTest("a build with sanitizers does not contain itself")
        return server

    def publish(self, server):
        process = subprocess.Popen(
            [CLIENT, "--server", server.address, "publish", "--synthetic", "--size", "64x48",
             "--stream", "scene", "--fps", "5", "--quiet"], stdout=subprocess.DEVNULL)
        self.addCleanup(process.wait, viewloomd.PATIENCE_S)
        self.addCleanup(process.send_signal, signal.SIGINT)

    def picture(self, server, display):
        """The JPEG of a display, once the stream is there and its kernels are compiled."""
        url = server.url + "still/scene.jpg?" + urllib.parse.urlencode(
            {"display": json.dumps(display)})
        deadline = time.monotonic() + viewloomd.PATIENCE_S
        while True:
            try:
                with urllib.request.urlopen(url, timeout=viewloomd.PATIENCE_S) as reply:
                    return reply.read()
            except urllib.error.HTTPError as error:
                said = error.read()
                if error.code not in (404, 504) or time.monotonic() > deadline:
                    raise AssertionError(said) from error
            time.sleep(0.1)

    def held(self, server):
        """What the kernel says of each thread: (no new rights, calls are filtered)."""
        states = set()
        for status in pathlib.Path(f"/proc/{server.process.pid}/task").glob("*/status"):
            lines = dict(line.split(":\t") for line in status.read_text().splitlines()
                         if line.startswith(("NoNewPrivs:", "Seccomp:")))
            states.add((lines["NoNewPrivs"] == "1", lines["Seccomp"] == "2"))
        return states

    def told(self, server):
        """What GetServerInfo says of it."""
        said = subprocess.run([CLIENT, "--server", server.address, "list", "server", "--json"],
                              capture_output=True, check=True, timeout=viewloomd.PATIENCE_S).stdout
        return json.loads(said)["containment"]

    def test_makes_all_pictures_and_is_refused_nothing(self):
        server = self.serve()
        self.publish(server)
        for display in DISPLAYS:
            self.assertEqual(self.picture(server, display)[:2], b"\xff\xd8", display)
        self.assertEqual(self.held(server), {(True, True)})
        log = self.log.read_text(encoding="utf-8")
        self.assertIn("system calls (seccomp)", log)
        self.assertNotIn("refused", log)
        self.assertIn("no core dumps, no new privileges", self.told(server))

    def test_listens_on_a_unix_socket(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        server = self.serve(address=f"unix:{folder.name}/socket")
        self.publish(server)
        self.assertEqual(self.picture(server, DISPLAYS[0])[:2], b"\xff\xd8")
        self.assertNotIn("refused", self.log.read_text(encoding="utf-8"))

    def test_is_switched_off_by_a_setting(self):
        server = self.serve("--containment.enabled", "false", "--containment.core_dumps", "true")
        self.assertEqual(self.held(server), {(False, False)})
        self.assertEqual(self.told(server), "none")
        self.assertIn("containment is off", self.log.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
