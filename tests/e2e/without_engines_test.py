# SPDX-License-Identifier: Apache-2.0
"""A server without engines: it has neither Vulkan nor an engine in it, runs, says what it is, and
refuses frames. How atlases that it is given reach viewers is tested without a pipeline anyhow
(rpc_watch_test). Arguments: viewloomd-without-engines, viewloom."""
import subprocess
import sys
import unittest
import urllib.request

import viewloomd  # takes its argument

CLIENT = sys.argv.pop(1)
PROGRAM = viewloomd.PROGRAM


class WithoutEngines(unittest.TestCase):
    def test_links_no_vulkan(self):
        libraries = subprocess.run(["readelf", "--dynamic", PROGRAM], capture_output=True,
                                   text=True, check=True).stdout
        self.assertIn("libgrpc++", libraries)
        self.assertNotIn("vulkan", libraries)

    def test_holds_no_engine(self):
        symbols = subprocess.run(["nm", "--demangle", PROGRAM], capture_output=True, text=True,
                                 check=True).stdout
        self.assertIn("viewloom::Broadcaster", symbols)
        for engine in ("ViewTracer", "ViewSweeper", "StructureBuilder", "PictureLoop"):
            self.assertNotIn(f"viewloom::{engine}", symbols)

    def test_doctor_says_so_and_finds_no_problem(self):
        doctor = subprocess.run([PROGRAM, "--grpc.address", "127.0.0.1:0", "--http.address",
                                 "127.0.0.1:0", "doctor"], capture_output=True, text=True,
                                check=False)
        self.assertEqual(doctor.returncode, 0, doctor.stdout)
        self.assertIn("engines  none are built in", doctor.stdout)

    def test_refuses_frames_and_goes_on(self):
        server = viewloomd.Viewloomd()
        self.addCleanup(server.stop)
        publish = subprocess.run(
            [CLIENT, "--server", server.address, "publish", "--synthetic", "--size", "64x48",
             "--stream", "scene", "--seconds", "1", "--fps", "2"], capture_output=True, text=True,
            check=False, timeout=viewloomd.PATIENCE_S)
        self.assertIn("built without engines", publish.stdout + publish.stderr)
        with urllib.request.urlopen(server.url + "healthz",
                                    timeout=viewloomd.PATIENCE_S) as reply:
            self.assertEqual(reply.status, 200)


if __name__ == "__main__":
    unittest.main()
