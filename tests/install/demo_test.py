#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""deploy/demo.sh with programs that only pretend: which size and which mirrors it chooses, and what
it refuses. The documents' tests run it with the real ones."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).parents[2]
PATIENCE_S = 60
# Names a device, and answers every request.
VIEWLOOMD = """#!/usr/bin/python3
import os, socket, sys
print("device: " + os.environ["PRETENDED_DEVICE"] + " (driver)", file=sys.stderr, flush=True)
host, port = sys.argv[sys.argv.index("--http.address") + 1].split(":")
with socket.create_server((host, int(port))) as server:
    while True:
        connection, _ = server.accept()
        connection.recv(4096)
        connection.sendall(b"HTTP/1.1 200 OK\\r\\n\\r\\n")
        connection.close()
"""
# A publisher leaves its arguments. A viewer gets its atlases in time if the frames are small.
VIEWLOOM = """#!/usr/bin/python3
import os, pathlib, signal, sys, time
note = pathlib.Path(os.environ["PRETENDED_NOTE"])
signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
value = lambda name: sys.argv[sys.argv.index(name) + 1]
if "publish" in sys.argv:
    note.write_text(" ".join(sys.argv[1:]))
    time.sleep(100)
time.sleep(0.5 if value("--count") == "2" else 0)  # the first viewer waits for the publisher
words = note.read_text().split()
width = int(words[words.index("--size") + 1].split("x")[0])
rate = float(words[words.index("--rate") + 1])
is_slow = width > int(os.environ["PRETENDED_WIDTH"])
time.sleep((2 if is_slow else 1) * (int(value("--count")) - 1) / rate)
"""


class DemoTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.checkout = pathlib.Path(folder.name)
        for name, text in {"build/release/server/viewloomd": VIEWLOOMD,
                           "build/release/client/cli/viewloom": VIEWLOOM,
                           "deploy/setup.sh": "#!/bin/sh\n", "tools/cmake": "#!/bin/sh\n"}.items():
            path = self.checkout / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            path.chmod(0o755)
        shutil.copy(ROOT / "deploy" / "demo.sh", self.checkout / "deploy")

    def environment(self, **more):
        return {**os.environ, "PATH": f"{self.checkout}/tools:{os.environ['PATH']}",
                "PRETENDED_NOTE": str(self.checkout / "note"), "PRETENDED_DEVICE": "llvmpipe",
                "PRETENDED_WIDTH": "9999", **more}

    def noted(self):
        """The arguments of the publisher that shows the scene; trials note theirs before it."""
        note = self.checkout / "note"
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            words = note.read_text(encoding="utf-8").split() if note.exists() else []
            if "publish" in words and "trial" not in words:
                note.unlink()
                return " ".join(words)
            time.sleep(0.01)
        raise TimeoutError("nobody publishes the scene")

    def logs(self):
        return "".join(f"\n{log.name}: {log.read_text(encoding='utf-8')}"
                       for log in sorted((self.checkout / "build" / "demo").glob("*.log")))

    def shown(self, **environment):
        """What it says until it shows the scene, and the arguments of its publisher."""
        demo = subprocess.Popen(["deploy/demo.sh"], cwd=self.checkout, text=True,
                                env=self.environment(**environment), stdout=subprocess.PIPE,
                                start_new_session=True)
        try:
            said = ""
            for line in demo.stdout:
                said += line
                if "Ctrl-C" in line:
                    break
            else:
                raise RuntimeError(f"the demo ended: {said}{self.logs()}")
            published = self.noted()
        finally:
            os.killpg(demo.pid, signal.SIGTERM)
            demo.communicate(timeout=PATIENCE_S)
        return said, published

    def test_takes_the_largest_size_that_keeps_up(self):
        said, published = self.shown(PRETENDED_WIDTH="500")
        self.assertIn("frames have 480x640 pixels: this machine does not keep 600x800", said)
        self.assertIn("--scene portrait --size 480x640 --rate 15", published)

    def test_takes_the_largest_of_all_on_a_fast_machine_and_mirrors_on_a_gpu(self):
        said, published = self.shown(PRETENDED_DEVICE="NVIDIA RTX A2000")
        self.assertIn("frames have 1200x1600 pixels: the largest of the demo", said)
        self.assertIn("--mirrors", published)
        self.assertRegex(said, r"http://127.0.0.1:\d+/\?display=\S*reflection")

    def test_measures_nothing_if_the_size_is_given(self):
        said, published = self.shown(VIEWLOOM_DEMO_SIZE="300x400", VIEWLOOM_DEMO_RATE="5")
        self.assertNotIn("measures", said)
        self.assertIn("--size 300x400 --rate 5", published)
        self.assertNotIn("--mirrors", published)
        self.assertTrue(re.search(r"http://127.0.0.1:\d+/\n", said))

    def test_switches_mirrors(self):
        _, published = self.shown(VIEWLOOM_DEMO_SIZE="300x400", VIEWLOOM_DEMO_MIRRORS="on")
        self.assertIn("--mirrors", published)
        _, published = self.shown(VIEWLOOM_DEMO_SIZE="300x400", VIEWLOOM_DEMO_MIRRORS="off",
                                  PRETENDED_DEVICE="NVIDIA RTX A2000")
        self.assertNotIn("--mirrors", published)

    def test_explains_itself_and_refuses_what_it_does_not_know(self):
        def call(*words, **environment):
            return subprocess.run(["deploy/demo.sh", *words], cwd=self.checkout, check=False,
                                  env=self.environment(**environment), capture_output=True,
                                  text=True, timeout=PATIENCE_S)
        help_text = call("--help").stdout
        for name in ("SIZE", "RATE", "MIRRORS"):
            self.assertIn(f"VIEWLOOM_DEMO_{name}", help_text)
        self.assertEqual(call("--mirrors").returncode, 2)
        wrong = call(VIEWLOOM_DEMO_MIRRORS="yes")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn('VIEWLOOM_DEMO_MIRRORS is "yes"; say on or off', wrong.stderr)


if __name__ == "__main__":
    unittest.main()
