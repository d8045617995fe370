# SPDX-License-Identifier: Apache-2.0
"""What an attack may cost, and what it did."""

import math
from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class Limits:
    pictures_share: float  # of those that the pair gets at rest
    longest_gap_s: float   # beside the longest gap at rest
    memory_mib: float      # peak, above what was there before
    cpu_s: float           # beside what the pair takes
    lost: float = math.inf  # pictures, by the times at which frames were made


# On a machine that does nothing else, the server alone. An attack may cost computing time while it
# lasts: the pair's pictures show whether that hurts.
FULL = Limits(pictures_share=0.9, longest_gap_s=0.3, memory_mib=64, cpu_s=8)
# While other tests run.
SUITE = Limits(pictures_share=0.5, longest_gap_s=2.0, memory_mib=128, cpu_s=8)
# A deployed pair of front and server. The front ends most attacks at once: half a second has no
# share of pictures worth judging, but those that were lost can be counted.
FRONT = Limits(pictures_share=0, longest_gap_s=0.3, memory_mib=16, cpu_s=0.3, lost=1)

# Floods that a front takes away: the server alone has to survive them, with that much memory (MiB).
FRONT_ONLY = {"rapid_reset": 640, "continuation": 1600, "header_drip": 640, "header_bomb": 256,
              "settings": 256, "ping": 256}
FLOODED_GAP_S = 5.0
# Attacks that keep what they send: frames of streams without a publisher, buffers of planes. Eight
# frames of 4096x4096 have planes of 112 MiB each, and take as much again while they are prepared.
MEMORY_KEPT = {"plane_bombs": 8 * 2 * 112, "gzip_messages": 128}
CPU_FRONT = {"tiny_windows": 2.0}


@dataclass
class Row:
    """One attack. Counts of the pair: during the attack, and as long at rest before it."""
    name: str
    pictures: int
    pictures_due: float
    longest_gap_s: float
    rest_gap_s: float
    memory_mib: float
    cpu_s: float
    found: list = field(default_factory=list)  # by the attack itself
    lost: int = 0                              # pictures between those that were seen

    def text(self):
        verdict = "; ".join(self.found) or "ok"
        return (f"| {self.name} | {self.pictures} of {self.pictures_due:.0f}, {self.lost} lost "
                f"| {self.longest_gap_s:.2f} | {self.memory_mib:.0f} | {self.cpu_s:.2f} "
                f"| {verdict} |")


HEADER = ("| attack | pictures | longest gap, s | memory, MiB | CPU, s | verdict |\n"
          "|---|---|---|---|---|---|")


def limits_of(name, limits, is_front):
    """What that attack may cost."""
    if is_front:
        return replace(limits, cpu_s=CPU_FRONT.get(name, limits.cpu_s))
    if name in FRONT_ONLY:
        return replace(limits, pictures_share=0, longest_gap_s=FLOODED_GAP_S,
                       memory_mib=FRONT_ONLY[name])
    return replace(limits, memory_mib=max(limits.memory_mib, MEMORY_KEPT.get(name, 0)))


def judged(row, limits, is_front=False):
    """The same row, with all that is beyond the limits."""
    limits = limits_of(row.name, limits, is_front)
    found = list(row.found)
    if row.pictures < limits.pictures_share * row.pictures_due - 1:
        found.append(f"pictures: {row.pictures} of {row.pictures_due:.0f}")
    if row.lost > limits.lost:
        found.append(f"lost: {row.lost} pictures, at most {limits.lost}")
    if row.longest_gap_s > limits.longest_gap_s + row.rest_gap_s:
        found.append(f"gap: {row.longest_gap_s:.2f} s")
    if row.memory_mib > limits.memory_mib:
        found.append(f"memory: {row.memory_mib:.0f} MiB, at most {limits.memory_mib:.0f}")
    if row.cpu_s > limits.cpu_s:
        found.append(f"CPU: {row.cpu_s:.2f} s, at most {limits.cpu_s:.2f}")
    row.found = found
    return row
