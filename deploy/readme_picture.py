#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/three_views.jpg, the README's first picture: three of the 48 views of a quilt of the
portrait scene, as `viewloom watch --views` writes them.

    deploy/readme_picture.py build/release/server/viewloomd build/release/client/cli/viewloom \\
        deploy/three_views.jpg
"""

import argparse
import tempfile

from PIL import Image

from studio import Studio

VIEWS = (2, 24, 45)
COLUMNS, ROWS = 8, 6
VIEW_PX = (420, 560)
GAP_PX = 6
SCENE = ["--synthetic", "--scene", "portrait", "--size", "1440x1920", "--layers", "4"]


def view_of(quilt, view):
    """Views run from the bottom left."""
    column, row = view % COLUMNS, ROWS - 1 - view // COLUMNS
    width_px, height_px = VIEW_PX
    return quilt.crop((column * width_px, row * height_px, (column + 1) * width_px,
                       (row + 1) * height_px))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("viewloomd", "viewloom", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(arguments, folder)
        studio.publish("portrait", *SCENE, "--seconds", "0.05", "--hold")
        try:
            quilt = studio.still("portrait", ["--preset", "portrait"])
        finally:
            studio.close()
    width_px = len(VIEWS) * VIEW_PX[0] + (len(VIEWS) - 1) * GAP_PX
    picture = Image.new("RGB", (width_px, VIEW_PX[1]), "white")
    for place, view in enumerate(VIEWS):
        picture.paste(view_of(quilt, view), (place * (VIEW_PX[0] + GAP_PX), 0))
    picture.save(arguments.picture, quality=85, optimize=True)


if __name__ == "__main__":
    main()
