# SPDX-License-Identifier: Apache-2.0
"""What one attack does to a healthy pair, and what it costs the server."""

import time

import judge

SETTLE_S = 0.3  # after an attack, for its end to show
RECOVERY_S = 15.0  # in which the pair is to be well again
LOOK_S, WELL_PICTURES = 0.7, 4  # what a pair that is well gets in that time, of seven


def is_well(pair, patience_s=RECOVERY_S):
    """Whether the pair gets its pictures, at the latest after that time."""
    end_s = time.monotonic() + patience_s
    while True:
        pair.take_count()
        time.sleep(LOOK_S)
        if pair.take_count()["seen"] >= WELL_PICTURES:
            return True
        if time.monotonic() >= end_s:
            return False


def measure(attack, server, pair, meter, address, its_budget):
    """Rest as long as the attack, then the attack."""
    pair.take_count()
    meter.start()
    time.sleep(min(its_budget.seconds, 3))
    rest = pair.take_count()
    rest_s = time.monotonic() - meter.begun_s
    rest_cpu_s = meter.used_cpu_s()
    meter.start()
    found = attack(address, its_budget) or []
    time.sleep(SETTLE_S)
    count = pair.take_count()
    took_s = time.monotonic() - meter.begun_s
    if not server.is_alive():
        return judge.Row(attack.__name__, 0, 1, took_s, 0, 0, 0, ["the server ended"])
    memory_mib = meter.peak_growth_mib()
    cpu_s = max(0.0, meter.used_cpu_s() - rest_cpu_s * took_s / rest_s)
    if not is_well(pair):
        found.append(f"the pair is not well {RECOVERY_S:.0f} s later")
    return judge.Row(attack.__name__, count["seen"], rest["seen"] * took_s / rest_s,
                     count["longest_gap_s"], rest["longest_gap_s"], memory_mib, cpu_s, found,
                     count["lost"])
