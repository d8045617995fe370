# SPDX-License-Identifier: Apache-2.0
"""Plants comments and documents that are hard to read, and asks for exactly that finding."""

import unittest

import language_rules
from planted_tree import rules_broken

LICENCE = "// SPDX-License-Identifier: Apache-2.0\n"
THIRTY = "one " * 29 + "two"


def broken(path, text):
    return [rule for _, rule in rules_broken(language_rules.check, {path: text})]


class Comments(unittest.TestCase):
    def test_one_that_begins_with_a_clause_is_found(self):
        for word in ("Of", "Who", "Whose", "What", "That", "As"):
            self.assertEqual(broken("a.h", f"// {word} the reads.\n"), ["comment"], word)

    def test_it_is_found_wherever_comments_are(self):
        for path, text in (("a.cpp", LICENCE + "// Of the reads.\n"),
                           ("a.cpp", "int a;  // of no use\nint b;  // Of the reads.\n"),
                           ("a.cpp", "// The reads.\n//\n// Of them.\n"),
                           ("a.comp", "  // What is read.\n"), ("a.proto", "// As above.\n"),
                           ("a.py", "x = 1  #" " Who reads.\n"), ("a.sh", "# That one.\n"),
                           ("CMakeLists.txt", "# Of the reads.\n")):
            self.assertEqual(broken(path, text), ["comment"], text)

    def test_others_are_free(self):
        for path, text in (("a.cpp", "// The reads,\n// of which there are two.\n"),
                           ("a.cpp", "// Offers what it has.\n"), ("a.cpp", '"// Of text"\n'),
                           ("a.sh", 'echo "${a# Of}"\n'), ("a.md", "# Of mice\n")):
            self.assertEqual(broken(path, text), [], text)


class Sentences(unittest.TestCase):
    def test_one_of_more_than_thirty_words_is_found(self):
        self.assertEqual(broken("a.md", f"{THIRTY}.\n"), [])
        self.assertEqual(broken("a.md", f"{THIRTY} three.\n"), ["sentence"])

    def test_it_is_found_over_lines_and_in_lists(self):
        text = f"{THIRTY} three."
        self.assertEqual(broken("a.md", text.replace(" two", "\ntwo")), ["sentence"])
        self.assertEqual(broken("a.md", f"- Short.\n- {text}\n"), ["sentence"])

    def test_code_tables_and_addresses_of_links_are_no_sentences(self):
        for text in (f"```\n{THIRTY} three\n```\n", f"    {THIRTY} three\n",
                     f"| {THIRTY} three |\n", "[a](b c d)" + " e" * 29 + ".\n",
                     f"{THIRTY}: {THIRTY}.\n", f"{THIRTY}\n\n{THIRTY}\n"):
            self.assertEqual(broken("a.md", text), [], text)


if __name__ == "__main__":
    unittest.main()
