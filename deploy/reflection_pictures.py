#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/reflections.jpg, the README's picture of reflections: the built-in scene with
mirrors from beside its source, without and with them, as `viewloom watch` writes it.

    deploy/reflection_pictures.py build/release/server/viewloomd \\
        build/release/client/cli/viewloom deploy/reflections.jpg
"""

import argparse
import json
import pathlib
import re
import signal
import subprocess
import tempfile

from PIL import Image

PATIENCE_S = 300
SIZE_PX = (600, 450)
SHIFT_M = 0.1


def display(effects):
    width_px, height_px = SIZE_PX
    focal_px = 1.9 * height_px  # looks past no side of the source
    return {"cameras": {"tile_size": {"width": width_px, "height": height_px}, "cameras": [
        {"pose": {"position": {"x": SHIFT_M}, "orientation": {"w": 1}}, "intrinsics": {
            "focal_x_px": focal_px, "focal_y_px": focal_px, "principal_x_px": width_px / 2,
            "principal_y_px": height_px / 2}}]}, "effects": effects}


class Studio:
    def __init__(self, arguments, folder):
        self.client, self.folder = arguments.viewloom, pathlib.Path(folder)
        self.server = subprocess.Popen(
            [arguments.viewloomd, "serve", "--http.address", "127.0.0.1:0", "--grpc.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = re.search(r"grpc=(\S+)", self.server.stdout.readline()).group(1)
        self.publisher = subprocess.Popen(
            [self.client, "--server", self.address, "publish", "--stream", "lake", "--synthetic",
             "--mirrors", "--size", "1440x1080", "--layers", "3", "--seconds", "0.05", "--hold",
             "--quiet"], stdout=subprocess.DEVNULL)

    def still(self, effects):
        message = self.folder / "display.json"
        message.write_text(json.dumps(display(effects)))
        stills = self.folder / "stills"
        subprocess.run([self.client, "--server", self.address, "watch", "lake", "--count", "1",
                        "--out", stills, "--format", "png", "--quiet", "--display", message],
                       check=True, timeout=PATIENCE_S, stdout=subprocess.DEVNULL)
        (path,) = stills.iterdir()
        with Image.open(path) as image:
            still = image.convert("RGB")
        path.unlink()
        return still

    def close(self):
        for process in (self.publisher, self.server):
            process.send_signal(signal.SIGINT)
            process.wait(PATIENCE_S)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("viewloomd", "viewloom", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(arguments, folder)
        try:
            stills = [studio.still({}), studio.still(
                {"reflection": {"bounces": 2, "environment_rgb": 0x8FA0B8}})]
        finally:
            studio.close()
    picture = Image.new("RGB", (2 * SIZE_PX[0], SIZE_PX[1]))
    for i, still in enumerate(stills):
        picture.paste(still, (i * SIZE_PX[0], 0))
    picture.save(arguments.picture, quality=85)


if __name__ == "__main__":
    main()
