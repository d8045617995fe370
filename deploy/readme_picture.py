#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/three_views.jpg, the README's first picture: three of the 48 views of a quilt of the
portrait scene, as `viewloom watch --views` writes them.

    deploy/readme_picture.py build/release/server/viewloomd build/release/client/cli/viewloom \\
        deploy/three_views.jpg
"""

from PIL import Image

from studio import PORTRAIT, make_picture

VIEWS = (2, 24, 45)
COLUMNS, ROWS = 8, 6
VIEW_PX = (420, 560)
GAP_PX = 6


def view_of(quilt, view):
    """Views run from the bottom left."""
    column, row = view % COLUMNS, ROWS - 1 - view // COLUMNS
    width_px, height_px = VIEW_PX
    return quilt.crop((column * width_px, row * height_px, (column + 1) * width_px,
                       (row + 1) * height_px))


def views(studio):
    quilt = studio.still("portrait", ["--preset", "portrait"])
    width_px = len(VIEWS) * VIEW_PX[0] + (len(VIEWS) - 1) * GAP_PX
    picture = Image.new("RGB", (width_px, VIEW_PX[1]), "white")
    for place, view in enumerate(VIEWS):
        picture.paste(view_of(quilt, view), (place * (VIEW_PX[0] + GAP_PX), 0))
    return picture


if __name__ == "__main__":
    make_picture(__doc__, {"portrait": PORTRAIT}, views)
