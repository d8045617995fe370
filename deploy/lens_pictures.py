#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes deploy/lens.jpg, the README's picture of a lens: a room without it, through it, in truth,
and how far the last two differ.

    deploy/lens_pictures.py build/release/tests/bench/viewloom-bench deploy/lens.jpg
"""

import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image, ImageChops

DIFFERENCE_GAIN = 8


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("bench", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([arguments.bench, "lens-pictures", folder], check=True)
        images = [Image.open(pathlib.Path(folder, name + ".ppm")).convert("RGB")
                  for name in ("sharp", "blurred", "truth")]
    difference = ImageChops.difference(images[1], images[2])
    images.append(difference.point(lambda code: min(DIFFERENCE_GAIN * code, 255)))
    width_px, height_px = images[0].size
    picture = Image.new("RGB", (2 * width_px, 2 * height_px))
    for i, image in enumerate(images):
        picture.paste(image, (i % 2 * width_px, i // 2 * height_px))
    picture.save(arguments.picture, quality=85)


if __name__ == "__main__":
    main()
