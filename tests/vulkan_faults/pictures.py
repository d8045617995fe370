# SPDX-License-Identifier: Apache-2.0
"""Pictures made without faults, and whether others are the same, byte by byte."""

import threading

import numpy as np

import viewloom


def planes_of(atlas):
    """{name: bytes} of what came losslessly. Raises ViewloomError where rows are missing."""
    planes = {"color": atlas.color, "inverse depth": atlas.inv_z, "mask": atlas.mask}
    return {name: np.ascontiguousarray(plane).tobytes() for name, plane in planes.items()}


def difference(name, wanted, got):
    if len(wanted) != len(got):
        return f"{name} has {len(got)} bytes instead of {len(wanted)}"
    unequal = np.count_nonzero(np.frombuffer(wanted, np.uint8) != np.frombuffer(got, np.uint8))
    return f"{unequal} of {len(wanted)} bytes of {name} differ" if unequal else ""


class Pictures:
    """Keeps the first picture of each display and frame while `is_learning`. Thread-safety: all
    methods may be called from any thread."""

    def __init__(self):
        self.is_learning = True
        self._known = {}
        self._lock = threading.Lock()

    def found(self, display, atlas):
        """What is wrong with that atlas; "" if nothing is."""
        try:
            planes = planes_of(atlas)
        except viewloom.ViewloomError as error:
            return f"torn: {display}: {error}"
        number = atlas.header.capture_time_ns
        with self._lock:
            if self.is_learning:
                self._known.setdefault((display, number), planes)
            wanted = self._known.get((display, number))
        if wanted is None:
            return f"wrong: {display} shows frame {number}, which it never should"
        if wanted.keys() != planes.keys():
            return f"wrong: {display} has other planes"
        apart = [difference(name, wanted[name], planes[name]) for name in wanted]
        apart = [text for text in apart if text]
        return f"wrong: {display}, frame {number}: {', '.join(apart)}" if apart else ""
