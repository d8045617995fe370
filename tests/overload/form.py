# SPDX-License-Identifier: Apache-2.0
"""How long a program goes on, and how strictly it judges."""

from dataclasses import dataclass

import verdicts
from attack_parts import Budget


@dataclass(frozen=True)
class Form:
    is_long: bool
    is_warm: bool  # kernels are compiled before anything is measured
    limits: verdicts.Limits
    client: Budget  # one client beside the pair
    many: Budget    # eight of them
    settle_s: float  # until memory is given back
    first: int = 0   # of seeds
    count: int = 2


SUITE = Form(is_long=False, is_warm=False, limits=verdicts.SUITE, client=Budget(1.5, 1),
             many=Budget(4.0, 1), settle_s=0.0)
SHORT = Form(is_long=False, is_warm=True, limits=verdicts.FULL, client=Budget(3.0, 1),
             many=Budget(8.0, 1), settle_s=10.0)
LONG = Form(is_long=True, is_warm=True, limits=verdicts.FULL, client=Budget(10.0, 10),
            many=Budget(40.0, 10), settle_s=10.0)
