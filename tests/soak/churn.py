# SPDX-License-Identifier: Apache-2.0
"""Clients that come and go, several at once. One client is one cycle."""

import collections
import itertools
import random
import threading
import time

from visits import Visit

# So often, a stream has a name that was never used before.
NEW_NAME_EACH = 7


class Churn:
    """Thread-safety: none; its workers are its own."""

    def __init__(self, place, actions, kinds, workers):
        self.place = place
        self.kinds = kinds
        self.workers = workers
        self.cycles = 0
        self.failures = collections.Counter()  # by words
        self._next = self._shuffled(actions)
        self._lock = threading.Lock()

    def _shuffled(self, actions):
        """Every action once, in random order, again and again."""
        for seed in itertools.count():
            order = list(actions)
            random.Random(seed).shuffle(order)
            yield from order

    def visit(self, worker, number):
        name = f"soak.{number}" if number % NEW_NAME_EACH == 0 else f"soak.of.{worker}"
        return Visit(self.place, name, number, random.Random(number), self.kinds)

    def _work(self, worker, end_s):
        while time.monotonic() < end_s:
            with self._lock:
                self.cycles += 1
                number, action = self.cycles, next(self._next)
            try:
                action(self.visit(worker, number))
            except Exception as error:  # whatever a client runs into is counted
                words = f"{action.__name__}: {type(error).__name__}: {str(error)[:160]}"
                with self._lock:
                    self.failures[words] += 1

    def run(self, seconds):
        end_s = time.monotonic() + seconds
        threads = [threading.Thread(target=self._work, args=(number, end_s))
                   for number in range(self.workers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
