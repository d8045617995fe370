# SPDX-License-Identifier: Apache-2.0
"""Parts of tests/attack that overload needs, too."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "attack"))
import http2  # noqa: E402
from budget import Budget  # noqa: E402
from healthy_pair import QUILT, RATE_HZ  # noqa: E402
from measure import measure  # noqa: E402
from target import Address, HealthyPair, Meter, Server  # noqa: E402

__all__ = ["Address", "Budget", "HealthyPair", "Meter", "QUILT", "RATE_HZ", "Server", "http2",
           "measure"]
