# SPDX-License-Identifier: Apache-2.0
"""Pictures of the documents, made by a server and a client of this tree."""

import argparse
import contextlib
import json
import pathlib
import re
import signal
import subprocess
import tempfile

from PIL import Image

PATIENCE_S = 300
# Options of a publisher: one frame, which stays.
ONE_FRAME = ["--seconds", "0.05", "--hold"]
PORTRAIT = ["--synthetic", "--scene", "portrait", "--size", "1440x1920", "--layers", "4",
            *ONE_FRAME]


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


def make_picture(description, publish, take, quality=85):
    """A script whose arguments are the programs viewloomd and viewloom, and the file of a picture.

    `publish`: the options of each stream, by name. `take`: makes the picture in a `Studio`.
    """
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("viewloomd", "viewloom", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with (tempfile.TemporaryDirectory() as folder,
          contextlib.closing(Studio(arguments, folder)) as studio):
        for stream, what in publish.items():
            studio.publish(stream, *what)
        picture = take(studio)
    picture.save(arguments.picture, quality=quality, optimize=True)
