# SPDX-License-Identifier: Apache-2.0
"""How long the files of C++ and GLSL are."""

import math
import statistics

SUFFIXES = (".h", ".cpp", ".glsl", ".comp", ".vert", ".frag")
# Shorter ones need a reason to stand alone.
SHORT_LINES = 40


def summary(tree):
    lengths = sorted(len(tree.lines(path)) for path in tree.text_files(*SUFFIXES))
    if not lengths:
        return "no files of C++ and GLSL"
    tenth_longest = lengths[math.ceil(0.9 * len(lengths)) - 1]
    short = sum(length < SHORT_LINES for length in lengths)
    return (f"{len(lengths)} files of C++ and GLSL: median {statistics.median(lengths):g} lines, "
            f"90th percentile {tenth_longest}, {short} under {SHORT_LINES}")
