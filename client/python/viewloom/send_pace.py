# SPDX-License-Identifier: Apache-2.0
"""When the next frame may be sent, at the rate at which the server uses frames."""

from __future__ import annotations

_RATE_MIN_HZ = 0.1


class SendPace:
    """Times are of one monotonic clock, s. Thread-safety: none."""

    def __init__(self) -> None:
        self._interval_s = 0.0
        self._sent_s = 0.0

    def set_rate(self, rate_hz: float) -> None:
        """Frames a second that are used; 0 = all."""
        self._interval_s = 1.0 / max(rate_hz, _RATE_MIN_HZ) if rate_hz > 0 else 0.0

    def left_s(self, now_s: float) -> float:
        """Time until the next frame may be sent; not above 0 = it may be sent now."""
        return self._sent_s + self._interval_s - now_s

    def note(self, now_s: float) -> None:
        """A frame is sent now. If it comes a little late, the next one need not."""
        late_s = -self.left_s(now_s)
        self._sent_s = now_s - max(late_s, 0.0) if late_s < self._interval_s / 2 else now_s
