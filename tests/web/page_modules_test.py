# SPDX-License-Identifier: Apache-2.0
"""Modules of the page that need no browser, tested by Node: eye_modules.js and eye_size_model.js.
Compact depth is packed here by another implementation than the server's."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest

import ray_scene
from ray_server import PAGE, compact_depth

NODE = shutil.which("node")
HERE = os.path.dirname(os.path.abspath(__file__))
CHECKS = ("eye_modules.js", "eye_size_model.js")
SIZE = (97, 151)  # odd sides, two bands


def write_depth(folder):
    """What compact_depth.js is to unpack, and what it is to find."""
    _, inv_z = ray_scene.look(ray_scene.Eye.straight(0.3, *SIZE), *SIZE)
    bands = compact_depth(inv_z)
    with open(os.path.join(folder, "packed.bin"), "wb") as file:
        file.write(b"".join(packed for _, packed in bands))
    blocks = [[float(inv_z[y:y + 2, x:x + 2].max()) for x in range(0, SIZE[0], 2)]
              for y in range(0, SIZE[1], 2)]
    with open(os.path.join(folder, "expected.json"), "w", encoding="ascii") as file:
        json.dump({"bands": [band for band, _ in bands], "width": SIZE[0], "blocks": blocks}, file)


@unittest.skipUnless(NODE, "there is no node")
class PageModules(unittest.TestCase):
    def test_modules_do_what_their_checks_expect(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in os.listdir(PAGE):
                if name.endswith(".js"):
                    shutil.copy(os.path.join(PAGE, name), folder)
            for name in CHECKS:
                shutil.copy(os.path.join(HERE, name), folder)
            with open(os.path.join(folder, "package.json"), "w", encoding="ascii") as file:
                json.dump({"type": "module"}, file)
            write_depth(folder)
            ran = subprocess.run([NODE, "--test", *CHECKS], cwd=folder, capture_output=True,
                                 text=True, check=False, timeout=300)
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)


if __name__ == "__main__":
    unittest.main()
