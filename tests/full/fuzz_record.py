# SPDX-License-Identifier: Apache-2.0
"""How long each target was searched, and how often it failed: kept for each state of what the
target is built from (fuzz_sources.py). What changes nothing of a target leaves its count alone.
"""

import datetime
import json
import pathlib
from dataclasses import dataclass

EXECUTIONS = 10_000_000
CPU_S = 2 * 3600
DAYS = 30


@dataclass(frozen=True)
class Searched:
    executions: int = 0
    cpu_s: float = 0.0
    failures: int = 0  # searches that a crash, a leak, a hang or too much memory ended

    def __add__(self, other):
        return Searched(self.executions + other.executions, self.cpu_s + other.cpu_s,
                        self.failures + other.failures)

    def share(self):
        """Of the goal; 1 = reached, but for failures."""
        return max(self.executions / EXECUTIONS, self.cpu_s / CPU_S)

    def text(self):
        return f"{self.executions:,} executions in {self.cpu_s / 60:.1f} CPU minutes"


class FuzzRecord:
    """Searches of one target, in a file: a row for each state and day."""

    def __init__(self, folder, target):
        self._file = pathlib.Path(folder) / "progress" / f"{target}.json"

    def of_state(self, state):
        return self._sum(lambda row: row["state"] == state)

    def of_last_days(self, today=None):
        """Over all states."""
        first = (today or datetime.date.today()) - datetime.timedelta(days=DAYS)
        return self._sum(lambda row: datetime.date.fromisoformat(row["day"]) > first)

    def add(self, state, searched, today=None):
        day = (today or datetime.date.today()).isoformat()
        rows = self._rows()
        row = next((row for row in rows if (row["state"], row["day"]) == (state, day)), None)
        if row is None:
            row = {"state": state, "day": day, "executions": 0, "cpu_s": 0.0, "failures": 0}
            rows.append(row)
        row["executions"] += searched.executions
        row["cpu_s"] = round(row["cpu_s"] + searched.cpu_s, 1)
        row["failures"] += searched.failures
        self._file.parent.mkdir(parents=True, exist_ok=True)
        # A whole file or none, whenever this is stopped.
        temporary = self._file.with_suffix(".new")
        temporary.write_text(json.dumps(rows, indent=1))
        temporary.replace(self._file)

    def _rows(self):
        if not self._file.exists():
            return []
        kept = json.loads(self._file.read_text())
        return kept if isinstance(kept, list) else []  # one of an earlier form

    def _sum(self, counts):
        return sum((Searched(row["executions"], row["cpu_s"], row["failures"])
                    for row in self._rows() if counts(row)), Searched())


def summary(folder, states, today=None):
    """Lines that say how far each target of {target: state} has come."""
    yield f"{'target':14}{'executions':>14}{'CPU minutes':>13}{'failures':>10}{'of the goal':>13}"
    reached, days = 0, Searched()
    for target, state in states.items():
        record = FuzzRecord(folder, target)
        now = record.of_state(state)
        reached += now.share() >= 1 and now.failures == 0
        days += record.of_last_days(today)
        yield (f"{target:14}{now.executions:14,}{now.cpu_s / 60:13.1f}{now.failures:10}"
               f"{min(now.share(), 1):13.0%}")
    yield (f"goal: {EXECUTIONS:,} executions or {CPU_S // 60} CPU minutes, without a failure; "
           f"{reached} of {len(states)} targets have reached it")
    yield (f"last {DAYS} days, all states: {days.executions:,} executions in "
           f"{days.cpu_s / 3600:.1f} CPU hours, {days.failures} failures")
