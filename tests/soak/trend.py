# SPDX-License-Identifier: Apache-2.0
"""The slope of a series, with its confidence interval."""

from dataclasses import dataclass

import numpy as np

SAMPLES_LEAST = 8
BOOTSTRAP_ROUNDS = 600
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Trend:
    """Bytes a cycle. low and high: the ends of the interval."""
    slope: float
    low: float
    high: float

    def text(self):
        return (f"{self.slope:.2f} bytes a cycle, {CONFIDENCE:.0%} interval {self.low:.2f} to "
                f"{self.high:.2f}")


def theil_sen(x, y):
    """The median of the slopes of all pairs: a fifth of the samples may be anything."""
    first, second = np.triu_indices(len(x), 1)
    return float(np.median((y[second] - y[first]) / (x[second] - x[first])))


def trend_of(cycles, sizes):
    """Theil-Sen, and a block bootstrap of what remains beside the line.

    Samples that follow each other are alike, so blocks of them are drawn, as long as the square
    root of their count. None: too few samples. cycles: ascending.
    """
    x, y = np.asarray(cycles, float), np.asarray(sizes, float)
    count = len(x)
    if count < SAMPLES_LEAST:
        return None
    slope = theil_sen(x, y)
    rest = y - slope * x
    # A line of two parameters goes nearer to its samples than the truth does.
    rest = (rest - np.median(rest)) * np.sqrt(count / (count - 2))
    block = max(1, round(np.sqrt(count)))
    random = np.random.default_rng(1)
    slopes = []
    for _ in range(BOOTSTRAP_ROUNDS):
        starts = random.integers(0, count, -(-count // block))
        drawn = (starts[:, None] + np.arange(block)) % count
        slopes.append(slope + theil_sen(x, rest[drawn.ravel()[:count]]))
    low, high = np.quantile(slopes, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return Trend(slope, float(low), float(high))
