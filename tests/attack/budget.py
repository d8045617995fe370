# SPDX-License-Identifier: Apache-2.0
"""How long an attack goes on, and how much it does."""

import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Budget:
    """scale: 1 in the short form; counts grow with it, never beyond what an attack allows."""
    seconds: float
    scale: float

    def count(self, short, most):
        return int(min(short * self.scale, most))

    def deadline(self):
        """A function that says whether time is over."""
        end_s = time.monotonic() + self.seconds
        return lambda: time.monotonic() >= end_s


SHORT = Budget(seconds=0.8, scale=1)
LONG = Budget(seconds=10.0, scale=10)
