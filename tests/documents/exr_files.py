# SPDX-License-Identifier: Apache-2.0
"""OpenEXR files without compression, flat and deep, from arrays of floats."""

import struct

import numpy as np

MAGIC, VERSION, DEEP = 20000630, 2, 0x800
FLOAT = 2


def _attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def _header(size, names, more):
    width, height = size
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", FLOAT, 0, 1, 1)
                        for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    return b"".join([
        _attribute("channels", "chlist", channels), _attribute("compression", "compression", b"\0"),
        _attribute("dataWindow", "box2i", window), _attribute("displayWindow", "box2i", window),
        _attribute("lineOrder", "lineOrder", b"\0"),
        _attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        _attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        _attribute("screenWindowWidth", "float", struct.pack("<f", 1)), *more, b"\0"])


def _write(path, flags, header, chunks):
    start = 8 + len(header) + 8 * len(chunks)
    offsets = []
    for chunk in chunks:
        offsets.append(start)
        start += len(chunk)
    path.write_bytes(struct.pack("<ii", MAGIC, VERSION | flags) + header
                     + struct.pack(f"<{len(offsets)}Q", *offsets) + b"".join(chunks))


def write_flat(path, planes):
    """`planes` are float[height][width] by the name of their channel."""
    names = sorted(planes)
    height, width = planes[names[0]].shape
    rows = [b"".join(planes[name][y].astype("<f4").tobytes() for name in names)
            for y in range(height)]
    chunks = [struct.pack("<ii", y, len(row)) + row for y, row in enumerate(rows)]
    _write(path, 0, _header((width, height), names, []), chunks)


def write_deep(path, planes):
    """`planes` are float[height][width][samples]: as many samples in each pixel."""
    names = sorted(planes)
    height, width, count = planes[names[0]].shape
    more = [_attribute("type", "string", b"deepscanline"),
            _attribute("version", "int", struct.pack("<i", 1)),
            _attribute("maxSamplesPerPixel", "int", struct.pack("<i", count)),
            _attribute("chunkCount", "int", struct.pack("<i", height))]
    counts = (count * np.arange(1, width + 1)).astype("<i4").tobytes()
    chunks = []
    for y in range(height):
        samples = b"".join(planes[name][y].astype("<f4").tobytes() for name in names)
        chunks.append(struct.pack("<iQQQ", y, len(counts), len(samples), len(samples))
                      + counts + samples)
    _write(path, DEEP, _header((width, height), names, more), chunks)
