# SPDX-License-Identifier: Apache-2.0
"""A conditional expression within co_await is found, also in a later line."""
import unittest

import coroutine_rules
from planted_tree import rules_broken


def broken(text):
    return rules_broken(coroutine_rules.check, {"server/web/a.cpp": text})


class Coroutines(unittest.TestCase):
    def test_a_conditional_argument_is_found(self):
        for text in ("co_await run(is_on ? std::string(\"on\") : \"\");",
                     "const int n = co_await run(1,\n    is_on ? \"on\" : \"\");"):
            self.assertEqual(broken(text), [("server/web/a.cpp", "coroutine")], text)

    def test_values_with_names_literals_and_conditions_outside_are_allowed(self):
        for text in ("const int n = is_on ? 1 : 0;\nco_await run(n);",
                     "co_await run(\"a?b\", '?');  // really?",
                     "if (co_await run(1)) { x = is_on ? 1 : 0; }"):
            self.assertEqual(broken(text), [], text)


if __name__ == "__main__":
    unittest.main()
