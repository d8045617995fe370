# SPDX-License-Identifier: Apache-2.0
"""`viewloom publish --tone-map` on linear files, and a manifest that says it itself. Arguments:
viewloomd, viewloom."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import viewloomd  # takes its argument

import numpy as np
from PIL import Image

CLIENT = sys.argv.pop(1)
SIZE = 32


def write_pfm(path, samples):
    """float32 [height][width], or [height][width][3]; bottom row first, little endian."""
    kind = b"PF" if samples.ndim == 3 else b"Pf"
    header = kind + b"\n%d %d\n-1\n" % (samples.shape[1], samples.shape[0])
    path.write_bytes(header + samples[::-1].astype("<f4").tobytes())


class ToneMap(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = viewloomd.Viewloomd()
        cls.addClassCleanup(cls.server.stop)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        write_pfm(cls.folder / "depth.pfm", np.full((SIZE, SIZE), 2.0))
        write_pfm(cls.folder / "color.pfm", np.full((SIZE, SIZE, 3), (6.0, 0.0, 0.0)))

    def run_client(self, *arguments):
        subprocess.run([CLIENT, "--server", self.server.address, *arguments], check=True,
                       timeout=viewloomd.PATIENCE_S, capture_output=True)

    def shown(self, name, *published):
        """The one colour that is left of the picture, 0..255."""
        self.run_client("publish", *published, "--stream", name, "--quiet")
        out = self.folder / f"out_{name}"
        self.run_client("watch", name, "--rgbd", f"{SIZE}x{SIZE}", "--depth-near", "1",
                        "--depth-far", "9", "--lossless", "--format", "png", "--count", "1",
                        "--quiet", "--out", str(out))
        (file,) = out.iterdir()
        with Image.open(file) as picture:
            (color,) = np.unique(np.asarray(picture)[:, :SIZE].reshape(-1, 3), axis=0)
        return color.tolist()

    def files(self):
        return [str(self.folder / "color.pfm"), "--depth", str(self.folder / "depth.pfm")]

    def test_maps_as_the_option_says(self):
        self.assertEqual(self.shown("plain", *self.files()), [255, 0, 0])
        self.assertEqual(self.shown("clip", *self.files(), "--tone-map", "clip"), [255, 0, 0])
        filmic = self.shown("filmic", *self.files(), "--tone-map", "filmic")
        self.assertEqual(filmic[1:], [0, 0])
        self.assertTrue(200 < filmic[0] < 255, filmic)
        agx = self.shown("agx", *self.files(), "--tone-map", "agx")
        self.assertTrue(agx[0] > agx[1] > 60 and agx[1] == agx[2], agx)

    def test_maps_as_a_manifest_says_and_the_option_overrides_it(self):
        manifest = {"toneMap": "TONE_MAP_AGX", "sources": [{
            "camera": {"fov": {"angleLeftRad": -0.4, "angleRightRad": 0.4, "angleUpRad": 0.4,
                               "angleDownRad": -0.4}},
            "layers": [{"color": {"file": "color.pfm"},
                        "depth": {"file": "depth.pfm",
                                  "depth": {"meaning": "DEPTH_MEANING_PLANAR"}}}]}]}
        file = self.folder / "frame.json"
        file.write_text(json.dumps(manifest), encoding="ascii")
        said = self.shown("said", "--manifest", str(file))
        self.assertGreater(said[1], 60)
        self.assertEqual(self.shown("over", "--manifest", str(file), "--tone-map", "clip"),
                         [255, 0, 0])


if __name__ == "__main__":
    unittest.main()
