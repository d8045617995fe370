# SPDX-License-Identifier: Apache-2.0
"""The package for Node is packed, installed in an empty folder and used there.

node_package_test.py PACKAGE VERSION VIEWLOOMD: the package in the build tree, the version of
viewloom, and a server.
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import npm

PACKAGE, VERSION, SERVER = pathlib.Path(sys.argv.pop(1)), sys.argv.pop(1), sys.argv.pop(1)
LIBRARY = ["viewloom.js", "command_line.js", "publish_frame.js", "watch_quilt.js"]
SCRATCH = tempfile.TemporaryDirectory()
FOLDER = pathlib.Path(SCRATCH.name)

ASK_SERVER = """
import {connect, status} from 'viewloom';
const client = connect('CatalogService', {server: process.argv[2]});
const ask = (method, request) => new Promise((resolve) =>
    client[method](request, (error, answer) => resolve(error ? status[error.code] : answer)));
console.log((await ask('GetServerInfo', {})).version);
console.log((await ask('ListPresets', {})).presets.some(({name}) => name === 'portrait'));
console.log(await ask('AdviseSource', {display: {preset: 'no_such'}}));
client.close();
"""


def pack_and_install():
    (FOLDER / "package.json").write_text('{"name": "scratch", "private": true}', encoding="ascii")
    packed, = json.loads(npm.run("pack", "--json", "--pack-destination", FOLDER, cwd=PACKAGE))
    (FOLDER / "packed.json").write_text(json.dumps(packed), encoding="utf-8")
    npm.install("install", f"./{packed['filename']}", cwd=FOLDER)


class NodePackage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [SERVER, "serve", "--grpc.address", "127.0.0.1:0", "--http.enabled", "false"],
            stdout=subprocess.PIPE, text=True)
        cls.address = re.search(r"grpc=(\S+)", cls.server.stdout.readline()).group(1)

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        assert cls.server.wait(npm.PATIENCE_S) == 0, "the server did not drain"
        cls.server.stdout.close()

    def start(self, script, *options):
        """An example of the installed package."""
        return subprocess.Popen(
            ["node", FOLDER / "node_modules" / "viewloom" / script, "--server", self.address,
             *options], cwd=FOLDER, stdout=subprocess.PIPE, text=True)

    def test_it_is_named_after_the_version_and_holds_what_it_needs(self):
        packed = json.loads((FOLDER / "packed.json").read_text(encoding="utf-8"))
        self.assertEqual((packed["name"], packed["version"], packed["filename"]),
                         ("viewloom", VERSION, f"viewloom-{VERSION}.tgz"))
        files = {file["path"] for file in packed["files"]}
        protos = {name for name in files if re.fullmatch(r"proto/viewloom/v1/\w+\.proto", name)}
        self.assertEqual(files - protos, {"LICENSE", "README.md", "package.json", *LIBRARY})
        self.assertIn("proto/viewloom/v1/display_service.proto", protos)

    def test_a_program_that_imports_it_asks_a_server(self):
        (FOLDER / "ask.mjs").write_text(ASK_SERVER, encoding="ascii")
        done = subprocess.run(["node", "ask.mjs", self.address], cwd=FOLDER, capture_output=True,
                              text=True, timeout=npm.PATIENCE_S, check=False)
        self.assertEqual((done.stdout, done.stderr), (f"{VERSION}\ntrue\nNOT_FOUND\n", ""))

    def test_its_examples_publish_and_watch(self):
        publisher = self.start("publish_frame.js")
        self.assertEqual(publisher.stdout.readline(),
                         "frame 1: FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY\n")
        said, _ = self.start("watch_quilt.js", "--out", "ball").communicate(
            timeout=npm.PATIENCE_S)
        self.assertIn("wrote ball_qs8x6a0.75.jpg", said)
        self.assertEqual((FOLDER / "ball_qs8x6a0.75.jpg").read_bytes()[:2], b"\xff\xd8")
        publisher.send_signal(signal.SIGINT)
        publisher.communicate(timeout=npm.PATIENCE_S)
        self.assertEqual(publisher.returncode, 0)


if __name__ == "__main__":
    npm.require(pack_and_install)
    unittest.main(verbosity=2)
