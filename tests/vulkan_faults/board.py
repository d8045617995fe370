# SPDX-License-Identifier: Apache-2.0
"""Memory that is shared with the layer under a server (fault_board.h)."""

import contextlib
import mmap
import os
import struct

import registry

HEAD = struct.Struct("=IIiIIIQ")
FUNCTION, LEFT, FAULT_COUNT, FAULT_NS = 4, 16, 20, 24
FUNCTIONS = registry.functions()
INDEX = {function.name: index for index, function in enumerate(FUNCTIONS)}


class FaultBoard:
    """Owns the memory; `file` is passed on to the server. Thread-safety: none."""

    def __init__(self):
        size = HEAD.size + 8 * len(FUNCTIONS)
        self.file = os.memfd_create("faults", 0)
        os.ftruncate(self.file, size)
        self._memory = mmap.mmap(self.file, size)

    def environment(self, layer_folder):
        return {"VK_LAYER_PATH": str(layer_folder),
                "VK_INSTANCE_LAYERS": "VK_LAYER_VIEWLOOM_fault",
                "VIEWLOOM_FAULT_BOARD": str(self.file)}

    def arm(self, function, number, result, stays_lost=True):
        """The call of that number from now on, counted from 1, fails."""
        self.disarm()
        fields = (INDEX[function], registry.RESULTS[result], stays_lost)
        self._memory[FUNCTION:LEFT] = struct.pack("=IiI", *fields)
        self._memory[LEFT:LEFT + 4] = struct.pack("=I", number)

    def disarm(self):
        self._memory[LEFT:LEFT + 4] = bytes(4)

    def check(self):
        """Raises where the server has no layer below it, or one of other functions."""
        count = struct.unpack_from("=I", self._memory)[0]
        if count != len(FUNCTIONS):
            raise RuntimeError(f"the layer knows {count} functions, and this program "
                               f"{len(FUNCTIONS)}: build viewloom_fault_layer")

    def fault_count(self):
        return struct.unpack_from("=I", self._memory, FAULT_COUNT)[0]

    def fault_s(self):
        """When the last fault was, on the clock of time.monotonic()."""
        return struct.unpack_from("=Q", self._memory, FAULT_NS)[0] / 1e9

    def counts(self):
        """{name: calls so far} of all functions that were called."""
        counts = struct.unpack_from(f"={len(FUNCTIONS)}Q", self._memory, HEAD.size)
        return {function.name: count for function, count in zip(FUNCTIONS, counts) if count}

    def close(self):
        with contextlib.suppress(OSError):
            os.close(self.file)
        self._memory.close()
