# SPDX-License-Identifier: Apache-2.0
"""Which calls fail: each function in each stage, and random ones."""

import random

import registry
from board import FUNCTIONS, INDEX
from judge import Fault
from stages import STAGES

# A handful for the suite: a refused start, memory that is missing for a structure, a wait that ends
# early, means of colour that are never made, a lost device.
SHORT = [
    ("start", Fault("vkCreateDevice", 1, "VK_ERROR_INITIALIZATION_FAILED")),
    ("first frame", Fault("vkAllocateMemory", 3, "VK_ERROR_OUT_OF_DEVICE_MEMORY")),
    ("first frame", Fault("vkWaitSemaphores", 1, "VK_TIMEOUT")),
    ("first frame", Fault("vkQueueSubmit2", 2, "VK_ERROR_DEVICE_LOST")),
    ("quilt", Fault("vkEndCommandBuffer", 1, "VK_ERROR_OUT_OF_HOST_MEMORY")),
]


def faults_of(function):
    return FUNCTIONS[INDEX[function]].faults


def fallible(counts):
    """{function: calls} of those that can return an error."""
    return {name: count for name, count in sorted(counts.items()) if faults_of(name)}


def faults_in(counts):
    """The first call of each function by each result, and one in the middle."""
    for name, count in fallible(counts).items():
        results = faults_of(name)
        for result in results:
            yield Fault(name, 1, result)
        if count > 1:
            result = registry.LOST if registry.LOST in results else results[0]
            yield Fault(name, count // 2 + 1, result)


def random_stages(seed):
    """One stage after the other, without an end; the call itself is drawn when the calls of the
    stage are known."""
    chooser = random.Random(seed)
    while True:
        yield chooser.choice(STAGES)


def random_fault(chooser, counts):
    """Any call of those that can fail, by any result that it may have; None if there is none, as
    where views are swept."""
    calls = [(name, number + 1) for name, count in fallible(counts).items()
             for number in range(count)]
    if not calls:
        return None
    name, number = chooser.choice(calls)
    return Fault(name, number, chooser.choice(faults_of(name)), chooser.random() < 0.8)
