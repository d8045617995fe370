# SPDX-License-Identifier: Apache-2.0
"""Stills for the README's pictures, made by a server and a client of this tree."""

import json
import pathlib
import re
import signal
import subprocess

from PIL import Image

PATIENCE_S = 300


class Studio:
    """A server, its streams, and stills of them. Close it."""

    def __init__(self, arguments, folder):
        self.client, self.folder = arguments.viewloom, pathlib.Path(folder)
        self.server = subprocess.Popen(
            [arguments.viewloomd, "serve", "--http.address", "127.0.0.1:0", "--grpc.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        line = self.server.stdout.readline()
        self.address, self.page = re.search(r"grpc=(\S+) http=(\S+)", line).groups()
        self.publishers = []

    def publish(self, stream, *what):
        self.publishers.append(subprocess.Popen(
            [self.client, "--server", self.address, "publish", "--stream", stream, *what,
             "--quiet"], stdout=subprocess.DEVNULL))

    def still(self, stream, watched):
        """An image of what `viewloom watch` writes. `watched`: its options, or a display."""
        options = watched
        if isinstance(watched, dict):
            message = self.folder / "display.json"
            message.write_text(json.dumps(watched))
            options = ["--display", message]
        stills = self.folder / "stills"
        subprocess.run([self.client, "--server", self.address, "watch", stream, "--count", "1",
                        "--out", stills, "--format", "png", "--quiet", *options],
                       check=True, timeout=PATIENCE_S, stdout=subprocess.DEVNULL)
        (path,) = stills.iterdir()
        with Image.open(path) as image:
            still = image.convert("RGB")
        path.unlink()
        return still

    def close(self):
        for process in [*self.publishers, self.server]:
            process.send_signal(signal.SIGINT)
            process.wait(PATIENCE_S)
