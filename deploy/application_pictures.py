#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the README's picture of an application of the tracer: what came in, what viewloom makes of
it, the truth, and how far the last two differ.

    deploy/application_pictures.py build/release/tests/bench/viewloom-bench deploy

writes deploy/APPLICATION.jpg for each of them.
"""

import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image, ImageChops

DIFFERENCE_GAIN = 8
WIDTH_PX = 960
APPLICATIONS = {"stereo": "stereo", "lens": "lens", "time": "between_frames",
                "things": "things_between_frames", "reflections": "mirror"}
PAIRS = {"stereo"}  # of which the left one is shown


def picture_of(folder, application):
    images = [Image.open(folder / f"{application}-{name}.ppm").convert("RGB")
              for name in ("input", "result", "truth")]
    if application in PAIRS:
        images[1:] = [image.crop((0, 0, image.width // 2, image.height)) for image in images[1:]]
    difference = ImageChops.difference(images[1], images[2])
    images.append(difference.point(lambda code: min(DIFFERENCE_GAIN * code, 255)))
    column_px = WIDTH_PX // 2
    images = [image.resize((column_px, image.height * column_px // image.width), Image.LANCZOS)
              for image in images]
    heights_px = [max(image.height for image in images[row:row + 2]) for row in (0, 2)]
    picture = Image.new("RGB", (WIDTH_PX, sum(heights_px)))
    for i, image in enumerate(images):
        picture.paste(image, (i % 2 * column_px, i // 2 * heights_px[0]))
    return picture


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([arguments.bench, "pictures", scratch], check=True)
        for application, name in APPLICATIONS.items():
            picture = picture_of(pathlib.Path(scratch), application)
            picture.save(arguments.folder / f"{name}.jpg", quality=85)


if __name__ == "__main__":
    main()
