# SPDX-License-Identifier: Apache-2.0
"""Every detector finds a fault that is planted: in what a server is said to have done, and in real
servers whose Vulkan lies. Arguments: viewloomd, the folder of the layer's manifest. PYTHONPATH has
the Python client."""

import itertools
import random
import sys
import unittest

PROGRAM, LAYERS = sys.argv.pop(1), sys.argv.pop(1)

import judge
import plan
import registry
from judge import Fault, Outcome
from pictures import Pictures
from stages import BY_NAME
from trial import Trial, born

LOST = Fault("vkQueueSubmit2", 1, "VK_ERROR_DEVICE_LOST")
SAID = ("2026-01-01T00:00:00.000+00:00 error the server cannot go on: the graphics device stopped "
        "answering\n")


def outcome(**changes):
    """A server that was served again, unless changed."""
    values = {"stage": "planted", "fault": LOST, "has_failed": True, "again_s": 0.5,
              "clean_s": 1.0, **changes}
    return Outcome(**values)


def ended(code, **changes):
    return outcome(**{"again_s": None, "end_s": 1.0, "exit_code": code,
                      "log": SAID, **changes})


class Judged(unittest.TestCase):
    def found(self, an_outcome, limits=judge.FULL):
        return "; ".join(judge.found(an_outcome, limits))

    def test_what_is_in_order_is_found_to_be(self):
        self.assertEqual(self.found(outcome()), "")
        self.assertEqual(self.found(ended(3)), "")
        refusal = "viewloomd: no usable Vulkan device; update the driver\n"
        self.assertEqual(self.found(ended(2, had_started=False, log=refusal)), "")
        self.assertEqual(self.found(ended(0, was_stopping=True, log="")), "")

    def test_each_fault_is_found(self):
        self.assertIn("not reached", self.found(outcome(has_failed=False)))
        self.assertIn("half alive", self.found(outcome(again_s=None)))
        self.assertIn("only after 3.5 s", self.found(outcome(again_s=3.5)))
        self.assertIn("does not end", self.found(outcome(was_stopping=True, again_s=None)))
        self.assertIn("wrong", self.found(outcome(wrong=["wrong: a quilt"])))
        self.assertIn("wrong", self.found(ended(3, wrong=["wrong: a quilt"])))
        self.assertIn("ended with -11", self.found(ended(-11)))
        self.assertIn("ended with 0", self.found(ended(0)))
        self.assertIn("ended with 2", self.found(ended(2)))
        self.assertIn("without a sentence", self.found(ended(3, log="terminate called\n")))
        self.assertIn("without a sentence", self.found(ended(2, had_started=False, log="")))
        self.assertIn("took 11.0 s", self.found(ended(3, end_s=11.0)))

    def test_kinds_are_told_apart(self):
        self.assertEqual(outcome().kind(), "served again")
        self.assertEqual(outcome(again_s=None).kind(), "half alive")
        self.assertEqual(outcome(wrong=["wrong"]).kind(), "wrong picture")
        self.assertEqual(ended(3).kind(), "exit 3")
        self.assertEqual(outcome(has_failed=False).kind(), "not reached")


class Planned(unittest.TestCase):
    def test_functions_fail_as_the_registry_says(self):
        faults = plan.faults_of("vkWaitSemaphores")
        self.assertIn("VK_TIMEOUT", faults)
        self.assertIn(registry.LOST, faults)
        self.assertNotIn(registry.LOST, plan.faults_of("vkCreateBuffer"))
        self.assertEqual(plan.faults_of("vkCmdDispatch"), ())

    def test_every_function_that_can_fail_does(self):
        counts = {"vkQueueSubmit2": 9, "vkCreateBuffer": 1, "vkCmdDispatch": 5}
        planned = list(plan.faults_in(counts))
        self.assertEqual({fault.function for fault in planned},
                         {"vkQueueSubmit2", "vkCreateBuffer"})
        self.assertIn(Fault("vkQueueSubmit2", 5, registry.LOST), planned)
        first, again = (list(itertools.islice(plan.random_stages(7), 5)) for _ in range(2))
        self.assertEqual(first, again)
        self.assertIsNone(plan.random_fault(random.Random(7), {"vkDestroyBuffer": 3}))


class Lying(unittest.TestCase):
    """Vulkan says that it succeeded and has done nothing."""

    @classmethod
    def setUpClass(cls):
        cls.pictures = Pictures()
        cls.stage = BY_NAME["first frame"]
        cls.clean = cls.live(patience_s=120)
        cls.pictures.is_learning = False

    @classmethod
    def live(cls, **words):
        life = born(PROGRAM, LAYERS, cls.stage, cls.pictures)
        try:
            return Trial(life, **words).outcome
        finally:
            life.close()

    def lie(self, function, number, patience_s):
        fault = Fault(function, number, "VK_SUCCESS")
        told = self.live(fault=fault, patience_s=patience_s, clean_s=self.clean.clean_s)
        self.assertTrue(told.has_failed)
        return "; ".join(judge.found(told, judge.SUITE))

    def test_the_same_without_a_lie_is_in_order(self):
        self.assertEqual(self.clean.wrong, [])
        self.assertIsNone(self.clean.exit_code)
        self.assertIn("vkQueueSubmit2", self.clean.counts)

    def test_a_wrong_picture_is_found(self):
        # The first walk of the picture: other dispatches may have nothing to do.
        self.assertIn("wrong: watched", self.lie("vkCmdDispatchBase", 1, 60))

    def test_a_server_that_hangs_is_found(self):
        said = self.lie("vkQueueSubmit2", 1, 3 * self.clean.clean_s)
        self.assertIn("half alive", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
