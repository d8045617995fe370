# SPDX-License-Identifier: Apache-2.0
"""What a server says of itself at /metrics."""

import re
import urllib.request
from dataclasses import dataclass

LINE = re.compile(r'^(\w+)(?:\{([^}]*)\})? (\S+)$', re.MULTILINE)


class Snapshot:
    """All values at one moment."""

    def __init__(self, text):
        self._values = {(name, labels): float(value) for name, labels, value in LINE.findall(text)}

    def value(self, name, **labels):
        """The sum over all labels that are not given."""
        wanted = [f'{key}="{value}"' for key, value in labels.items()]
        return sum(value for (one, its_labels), value in self._values.items()
                   if one == name and all(word in its_labels for word in wanted))

    def bounds(self, name):
        """Upper bounds of the buckets of a histogram, growing."""
        found = {float(bound) for (one, labels) in self._values if one == f"{name}_bucket"
                 for bound in re.findall(r'le="([^"]+)"', labels)}
        return sorted(found)

    def buckets(self, name, **labels):
        """(upper bound, count up to it)."""
        totals = {bound: 0.0 for bound in self.bounds(name)}
        wanted = [f'{key}="{value}"' for key, value in labels.items()]
        for (one, its_labels), value in self._values.items():
            if one == f"{name}_bucket" and all(word in its_labels for word in wanted):
                totals[float(re.search(r'le="([^"]+)"', its_labels).group(1))] += value
        return sorted(totals.items())


@dataclass(frozen=True)
class Histogram:
    buckets: tuple  # (upper bound, count up to it), of what came between two snapshots

    @staticmethod
    def between(before, after, name, **labels):
        earlier = dict(before.buckets(name, **labels))
        return Histogram(tuple((bound, count - earlier.get(bound, 0))
                               for bound, count in after.buckets(name, **labels)))

    def count(self):
        return self.buckets[-1][1] if self.buckets else 0

    def quantile(self, share):
        """Evenly between the bounds of its bucket; infinity beyond the last bound, 0 of nothing."""
        lower_bound = lower_count = 0.0
        for bound, count in self.buckets:
            if count > 0 and count >= share * self.count():
                if bound == float("inf"):
                    return bound
                part = (share * self.count() - lower_count) / (count - lower_count)
                return lower_bound + part * (bound - lower_bound)
            lower_bound, lower_count = bound, count
        return 0.0


def read(address, token=""):
    request = urllib.request.Request(f"http://127.0.0.1:{address.http_port}/metrics")
    if token:
        request.add_header("Authorization", f"Bearer {token}")
    with urllib.request.urlopen(request, timeout=60) as reply:
        return Snapshot(reply.read().decode())
