#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/reflections.jpg, the README's picture of reflections: the built-in scene with
mirrors from beside its source, without and with them, as `viewloom watch` writes it.

    deploy/reflection_pictures.py build/release/server/viewloomd \\
        build/release/client/cli/viewloom deploy/reflections.jpg
"""

import argparse
import tempfile

from PIL import Image

from studio import Studio

SIZE_PX = (600, 450)
SHIFT_M = 0.1


def display(effects):
    width_px, height_px = SIZE_PX
    focal_px = 1.9 * height_px  # looks past no side of the source
    return {"cameras": {"tile_size": {"width": width_px, "height": height_px}, "cameras": [
        {"pose": {"position": {"x": SHIFT_M}, "orientation": {"w": 1}}, "intrinsics": {
            "focal_x_px": focal_px, "focal_y_px": focal_px, "principal_x_px": width_px / 2,
            "principal_y_px": height_px / 2}}]}, "effects": effects}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("viewloomd", "viewloom", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(arguments, folder)
        studio.publish("lake", "--synthetic", "--mirrors", "--size", "1440x1080", "--layers", "3",
                       "--seconds", "0.05", "--hold")
        try:
            stills = [studio.still("lake", display(effects)) for effects in
                      ({}, {"reflection": {"bounces": 2, "environment_rgb": 0x8FA0B8}})]
        finally:
            studio.close()
    picture = Image.new("RGB", (2 * SIZE_PX[0], SIZE_PX[1]))
    for i, still in enumerate(stills):
        picture.paste(still, (i * SIZE_PX[0], 0))
    picture.save(arguments.picture, quality=85)


if __name__ == "__main__":
    main()
