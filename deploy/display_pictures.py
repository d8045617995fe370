#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/displays.jpg, the README's picture of every kind of display: one still of each, as
`viewloom watch` writes it, of one frame of the built-in scene.

    deploy/display_pictures.py build/release/server/viewloomd build/release/client/cli/viewloom \\
        deploy/displays.jpg
"""

from PIL import Image, ImageDraw, ImageFont

from studio import ONE_FRAME, make_picture

GAP_PX = 12
SCENE = ["--synthetic", "--size", "1440x1080", "--layers", "4", *ONE_FRAME]
PATTERN = ["--pattern", "view-numbers", "--views", "6"]
QUILT = {"quilt": {"columns": 4, "rows": 2, "size": {"width": 1440, "height": 1080}}}
STEREO = {"stereo": {"eye_size": {"width": 720, "height": 540}}}
GRID = {"cameras": {"tile_size": {"width": 360, "height": 270},
                    "grid": {"columns": 3, "rows": 3, "spacing_x_m": 0.15, "spacing_y_m": 0.15}}}
NEAR_EYE = {"integral": {"preset": "near_eye_2013"}}
RGBD = {"rgbd": {"view_size": {"width": 720, "height": 540}}}
TWO_LAYERS = {"rgbd": {"view_size": {"width": 480, "height": 360}, "form": "RGBD_FORM_TWO_LAYERS"}}
PANEL = ["--preset", "portrait", "--native"]
NUMBERS = {"quilt": {"columns": 3, "rows": 2, "size": {"width": 1260, "height": 1120},
                     "view_cone_rad": 0.698131700797732}}
# Caption, stream, display, and what of it is shown how many times as large.
ROWS = [
    [("quilt: 8 views, 0 at the bottom left", "scene", QUILT, None, 1),
     ("stereo: side by side", "scene", STEREO, None, 1)],
    [("cameras: a grid of 3 x 3", "scene", GRID, None, 1),
     ("integral: the near-eye panel's elemental images", "scene", NEAR_EYE, None, 1)],
    [("lenticular: a panel's own px", "scene", PANEL, None, 1),
     ("64 of them on a side, eight times as large", "scene", PANEL, (736, 1100, 800, 1164), 8),
     ("view numbers: each view sees its own", "pattern", NUMBERS, None, 1)],
    [("rgbd: colour and depth", "scene", RGBD, None, 1),
     ("rgbd: two layers", "scene", TWO_LAYERS, None, 1)],
]
ROW_HEIGHT_PX = 330
WIDTH_PX = 900


def tile(studio, caption, stream, watched, box, times):
    image = studio.still(stream, watched)
    if box:
        image = image.crop(box).resize(((box[2] - box[0]) * times, (box[3] - box[1]) * times),
                                       Image.Resampling.NEAREST)
    width_px = round(image.width * ROW_HEIGHT_PX / image.height)
    image = image.resize((width_px, ROW_HEIGHT_PX), Image.Resampling.BOX if box
                         else Image.Resampling.LANCZOS)
    font = ImageFont.load_default()
    labelled = Image.new("RGB", (width_px, ROW_HEIGHT_PX + 18), "white")
    labelled.paste(image, (0, 18))
    ImageDraw.Draw(labelled).text((2, 3), caption, "black", font)
    return labelled


def row_of(tiles):
    """Side by side, as wide as the sheet."""
    width_px = sum(image.width for image in tiles) + GAP_PX * (len(tiles) - 1)
    height_px = max(image.height for image in tiles)
    row = Image.new("RGB", (width_px, height_px), "white")
    x_px = 0
    for image in tiles:
        row.paste(image, (x_px, 0))
        x_px += image.width + GAP_PX
    if width_px <= WIDTH_PX:
        return row
    return row.resize((WIDTH_PX, round(height_px * WIDTH_PX / width_px)), Image.Resampling.LANCZOS)


def sheet(studio):
    rows = [row_of([tile(studio, *each) for each in row]) for row in ROWS]
    picture = Image.new("RGB", (WIDTH_PX, sum(row.height + GAP_PX for row in rows) - GAP_PX),
                        "white")
    y_px = 0
    for row in rows:
        picture.paste(row, (0, y_px))
        y_px += row.height + GAP_PX
    return picture


if __name__ == "__main__":
    make_picture(__doc__, {"scene": SCENE, "pattern": PATTERN}, sheet, quality=58)
