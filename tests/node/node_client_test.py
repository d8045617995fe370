# SPDX-License-Identifier: Apache-2.0
"""A foreign client: the examples for Node publish a frame and watch a quilt of it."""

import hashlib
import io
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

from PIL import Image

import npm

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "show"))
from fake_displays import FakeDisplays  # noqa: E402

from viewloom.v1 import atlas_pb2  # noqa: E402
from viewloom.v1.display_service_pb2 import StreamAtlasesResponse  # noqa: E402

SERVER, FOLDER, PROTOS = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1)), sys.argv.pop(1)

PATIENCE_S = npm.PATIENCE_S


def install():
    """node_modules as the lock file has it; kept until that changes."""
    lock = hashlib.sha256((FOLDER / "package-lock.json").read_bytes()).hexdigest()
    stamp = FOLDER / "node_modules" / ".installed_lock"
    if stamp.is_file() and stamp.read_text(encoding="ascii") == lock:
        return
    npm.install("ci", cwd=FOLDER)
    stamp.write_text(lock, encoding="ascii")


class AbandonedThenWhole:
    """An atlas that the server gives up after its first band, then a whole one of another
    colour."""

    layout = atlas_pb2.AtlasLayout(
        size={"width": 16, "height": 16}, columns=1, rows=1, view_count=1, image_count=1,
        tile_size={"width": 16, "height": 16}, suffix="_qs1x1a1")

    @staticmethod
    def _begun(sequence, colour):
        file = io.BytesIO()
        Image.new("RGB", (16, 16), colour).save(file, "JPEG")
        band = {"sequence": sequence, "plane": atlas_pb2.ATLAS_PLANE_COLOR, "row_count": 16,
                "encoding": atlas_pb2.BAND_ENCODING_JPEG, "data": file.getvalue(),
                "last_piece": True}
        return [StreamAtlasesResponse(header={"sequence": sequence, "frame_number": sequence,
                                              "band_count": 1}), StreamAtlasesResponse(band=band)]

    def messages(self, _):
        return [*self._begun(1, "red"), StreamAtlasesResponse(abandoned={"sequence": 1}),
                *self._begun(2, "lime"), StreamAtlasesResponse(end={"sequence": 2})]


class NodeClient(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [SERVER, "serve", "--grpc.address", "127.0.0.1:0", "--http.enabled", "false"],
            stdout=subprocess.PIPE, text=True)
        cls.address = re.search(r"grpc=(\S+)", cls.server.stdout.readline()).group(1)
        cls.publisher = cls.start("publish_frame.js")
        cls.reported = cls.publisher.stdout.readline()

    @classmethod
    def tearDownClass(cls):
        cls.publisher.send_signal(signal.SIGINT)
        assert cls.publisher.wait(PATIENCE_S) == 0, "the publisher did not end in order"
        cls.publisher.stdout.close()
        cls.server.terminate()
        assert cls.server.wait(PATIENCE_S) == 0, "the server did not drain"
        cls.server.stdout.close()

    @classmethod
    def command(cls, script, *options):
        return ["node", FOLDER / script, "--server", cls.address, "--protos", PROTOS, *options]

    @classmethod
    def start(cls, script):
        return subprocess.Popen(cls.command(script), stdout=subprocess.PIPE, text=True)

    def watch(self, *options):
        """The finished process, and what it wrote: name → picture."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(self.command("watch_quilt.js", *options), cwd=folder,
                                  capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            pictures = {}
            for file in pathlib.Path(folder).iterdir():
                pictures[file.name] = Image.open(file)
                pictures[file.name].load()
            return done, pictures

    def test_the_frame_is_reported_built(self):
        self.assertEqual(self.reported, "frame 1: FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY\n")

    def test_a_quilt_is_written_as_the_layout_says(self):
        done, pictures = self.watch("--preset", "portrait", "--out", "ball")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, "frame 1: 8x6 tiles, 48 views of 420x560 px, "
                         "TILE_ORDER_BOTTOM_LEFT; wrote ball_qs8x6a0.75.jpg\n")
        quilt = pictures["ball_qs8x6a0.75.jpg"]
        self.assertEqual((quilt.format, quilt.size), ("JPEG", (8 * 420, 6 * 560)))
        for view in (0, 23, 24, 47):  # each has the red ball in its middle and the wall beside it
            left, bottom = view % 8 * 420, quilt.height - view // 8 * 560
            red, _, blue = quilt.getpixel((left + 210, bottom - 280))
            self.assertGreater(red, 2 * blue, f"view {view}")
            red, _, blue = quilt.getpixel((left + 210, bottom - 20))
            self.assertGreater(blue, 2 * red, f"view {view}")

    def test_an_atlas_that_is_abandoned_is_never_written(self):
        server = FakeDisplays(lambda _: AbandonedThenWhole())
        self.addCleanup(server.stop)
        done, pictures = self.watch("--server", server.address, "--out", "whole")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("frame 2:", done.stdout)
        red, green, _ = pictures["whole_qs1x1a1.jpg"].getpixel((8, 8))
        self.assertGreater(green, 2 * red)

    def test_a_refusal_is_one_line_that_names_the_field(self):
        done, pictures = self.watch("--preset", "no_such")
        self.assertEqual((done.returncode, done.stdout, pictures), (1, "", {}))
        self.assertRegex(done.stderr,
                         r"\ANOT_FOUND: open\.display\.preset: .*portrait.*\n\Z")

    def test_a_stream_or_a_server_that_is_not_there_is_one_line_with_a_remedy(self):
        done, pictures = self.watch("--stream", "nothere")
        self.assertEqual((done.returncode, done.stdout, pictures), (1, "", {}))
        self.assertRegex(done.stderr, r"\ANOT_FOUND: .*nothere.*demo.*\n\Z")
        done, pictures = self.watch("--server", "127.0.0.1:1")
        self.assertEqual((done.returncode, done.stdout, pictures), (1, "", {}))
        self.assertRegex(done.stderr, r"\Ano viewloomd answers at 127\.0\.0\.1:1: start one with "
                                      r"`viewloomd serve`.*\n\Z")


if __name__ == "__main__":
    npm.require(install)
    unittest.main(verbosity=2)
