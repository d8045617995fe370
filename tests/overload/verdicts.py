# SPDX-License-Identifier: Apache-2.0
"""Figures of overload: what is measured, what is allowed, and what is wrong."""

from dataclasses import dataclass, field

IDENTITY_COUNT = 9  # eight clients and the second pair; the healthy pair needs next to nothing
PIECES_NEEDED = 100  # before anything is said of the longest hundredth
NO_LIMIT = float("inf")


@dataclass(frozen=True)
class Limits:
    """All that is judged. Times in s."""
    pictures_share: float  # of those due; beside a single client
    gap_s: float
    many_pictures_share: float  # beside eight clients
    many_gap_s: float
    share_error: float    # of the second pair's share of the engines
    predicted_piece_s: float
    measured_piece_s: float
    memory_over_budget: float   # share
    memory_kept: float          # share of the memory at rest, after clients have left
    exit_s: float
    dropped: float        # atlases of a fast viewer
    age_ratio: float      # beside slow viewers, or that much more:
    age_more_s: float
    efficiency: float     # pictures per CPU second, of the best
    rate_kept: float      # pictures a second, of those with fewer streams
    refusal_s: float


# On a machine that does nothing else.
FULL = Limits(pictures_share=0.9, gap_s=0.3, many_pictures_share=0.9, many_gap_s=1.0,
              share_error=0.2, predicted_piece_s=0.010, measured_piece_s=0.030,
              memory_over_budget=0.1, memory_kept=0.05, exit_s=10, dropped=0, age_ratio=1.3,
              age_more_s=0.005, efficiency=0.9, rate_kept=0.95, refusal_s=0.010)
# While other tests run, for a second or two, of a server that compiles kernels meanwhile: what is
# starved or torn altogether.
SUITE = Limits(pictures_share=0.2, gap_s=3.0, many_pictures_share=0.05, many_gap_s=10.0,
               share_error=NO_LIMIT, predicted_piece_s=NO_LIMIT, measured_piece_s=NO_LIMIT,
               memory_over_budget=0.1, memory_kept=NO_LIMIT, exit_s=30, dropped=NO_LIMIT,
               age_ratio=20, age_more_s=2.0, efficiency=0.3, rate_kept=0.3, refusal_s=1.0)


@dataclass
class BesideRow:
    """The healthy pair beside clients. Shares of pictures are of those due at rest."""
    name: str
    pictures: int
    pictures_due: float
    gap_s: float
    rest_gap_s: float
    client_cpu_s: float  # of the clients, not of the pair
    server_cpu_s: float  # beside what the pair takes
    atlases: int         # that the clients got
    predicted_p99_s: float = 0.0  # of all pieces of engine work meanwhile
    measured_p99_s: float = 0.0
    refusals: list = field(default_factory=list)
    found: list = field(default_factory=list)

    HEADER = ("| beside | pictures | longest gap, s | at rest | CPU of server, s | of clients, s "
              "| their atlases | p99 of pieces, predicted, ms | measured | refused | verdict |\n"
              "|---|---|---|---|---|---|---|---|---|---|---|")

    def text(self):
        refused = "; ".join(one[:60] for one in self.refusals) or "-"
        return (f"| {self.name} | {self.pictures} of {self.pictures_due:.0f} | {self.gap_s:.2f} "
                f"| {self.rest_gap_s:.2f} | {self.server_cpu_s:.1f} | {self.client_cpu_s:.1f} "
                f"| {self.atlases} | {self.predicted_p99_s * 1e3:.1f} "
                f"| {self.measured_p99_s * 1e3:.1f} | {refused} | {verdict(self)} |")


def verdict(row):
    return "; ".join(row.found) or "ok"


def judged_beside(row, limits):
    return judged_pictures(row, limits.pictures_share, limits.gap_s)


def judged_beside_many(row, limits):
    return judged_pictures(row, limits.many_pictures_share, limits.many_gap_s)


def judged_pictures(row, share, gap_s):
    if row.pictures < share * row.pictures_due - 1:
        row.found.append(f"pictures: {row.pictures} of {row.pictures_due:.0f}")
    if row.gap_s > max(gap_s, row.rest_gap_s):
        row.found.append(f"gap: {row.gap_s:.2f} s, at most {gap_s:.1f}")
    return row


@dataclass
class ShareRow:
    """A pair that asks for more than its share."""
    demand: float  # share of the engines' time that all its frames would take
    share: float   # that it got
    found: list = field(default_factory=list)

    HEADER = ("| a pair asks for, share of the engines | gets | verdict |\n|---|---|---|")

    def text(self):
        return f"| {self.demand:.3f} | {self.share:.3f} | {verdict(self)} |"


def judged_share(row, limits):
    fair = 1 / IDENTITY_COUNT
    if row.demand < fair:
        row.found.append("the second pair asks for less than its share")
    if abs(row.share - fair) > limits.share_error * fair:
        row.found.append(f"share: {row.share:.3f}, fair is {fair:.3f}")
    return row


@dataclass
class PieceRow:
    """Pieces of one kind of engine work: the time that 99 of 100 do not exceed."""
    work: str
    count: int
    predicted_p99_s: float
    measured_p99_s: float
    longest_s: float
    found: list = field(default_factory=list)

    HEADER = ("| pieces | count | p99 predicted, ms | p99 measured, ms | longest, ms | verdict |\n"
              "|---|---|---|---|---|---|")

    def text(self):
        return (f"| {self.work} | {self.count} | {self.predicted_p99_s * 1e3:.1f} "
                f"| {self.measured_p99_s * 1e3:.1f} | {self.longest_s * 1e3:.0f} "
                f"| {verdict(self)} |")


def judged_pieces(row, limits):
    if row.count < PIECES_NEEDED:
        row.found.append(f"{row.count} pieces: too few to judge")
        return row
    if row.predicted_p99_s > limits.predicted_piece_s:
        row.found.append(f"predicted: {row.predicted_p99_s * 1e3:.1f} ms")
    if row.measured_p99_s > limits.measured_piece_s:
        row.found.append(f"measured: {row.measured_p99_s * 1e3:.1f} ms")
    return row


@dataclass
class MemoryRow:
    """Resident memory, MiB. rest: after one use of every kind."""
    budget_mib: float
    rest_mib: float
    peak_mib: float
    left_mib: float  # some time after all clients have left
    found: list = field(default_factory=list)

    HEADER = ("| memory: budget, MiB | at rest | peak | after clients left | verdict |\n"
              "|---|---|---|---|---|")

    def text(self):
        return (f"| {self.budget_mib:.0f} | {self.rest_mib:.0f} | {self.peak_mib:.0f} "
                f"| {self.left_mib:.0f} | {verdict(self)} |")


def judged_memory(row, limits):
    if row.peak_mib > row.budget_mib * (1 + limits.memory_over_budget):
        row.found.append(f"peak: {row.peak_mib:.0f} MiB of a budget of {row.budget_mib:.0f}")
    if row.left_mib > row.rest_mib * (1 + limits.memory_kept):
        row.found.append(f"kept: {row.left_mib - row.rest_mib:.0f} MiB more than at rest")
    return row
