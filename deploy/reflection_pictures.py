#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/reflections.jpg, the README's picture of reflections: the built-in scene with
mirrors from beside its source, without and with them, as `viewloom watch` writes it.

    deploy/reflection_pictures.py build/release/server/viewloomd \\
        build/release/client/cli/viewloom deploy/reflections.jpg
"""

from PIL import Image

from studio import ONE_FRAME, make_picture

SIZE_PX = (600, 450)
SHIFT_M = 0.1
LAKE = ["--synthetic", "--mirrors", "--size", "1440x1080", "--layers", "3", *ONE_FRAME]


def display(effects):
    width_px, height_px = SIZE_PX
    focal_px = 1.9 * height_px  # looks past no side of the source
    return {"cameras": {"tile_size": {"width": width_px, "height": height_px}, "cameras": [
        {"pose": {"position": {"x": SHIFT_M}, "orientation": {"w": 1}}, "intrinsics": {
            "focal_x_px": focal_px, "focal_y_px": focal_px, "principal_x_px": width_px / 2,
            "principal_y_px": height_px / 2}}]}, "effects": effects}


def both(studio):
    picture = Image.new("RGB", (2 * SIZE_PX[0], SIZE_PX[1]))
    for i, effects in enumerate(({}, {"reflection": {"bounces": 2,
                                                     "environment_rgb": 0x8FA0B8}})):
        picture.paste(studio.still("lake", display(effects)), (i * SIZE_PX[0], 0))
    return picture


if __name__ == "__main__":
    make_picture(__doc__, {"lake": LAKE}, both)
