# SPDX-License-Identifier: Apache-2.0
"""A link of a document that leads to no file, or to no heading, is found."""
import unittest

import link_rules
from planted_tree import rules_broken


class Links(unittest.TestCase):
    FILES = {"README.md": "[a](deploy/a.md) [b](deploy/) [c](https://example.org/#x)\n"
                          "[d](#an-end)\n```\n# No heading\n```\n## An end\n",
             "deploy/a.md": "[back](../README.md#an-end-1)\n"
                            "# The [way](b.md), `x`\n[on](#the-way-x)",
             "deploy/b.md": "## An end\n## An end\n[e](#an-end-1)"}

    def broken(self, **changed):
        files = {**self.FILES, **{name.replace("__", "/") + ".md": text
                                  for name, text in changed.items()}}
        return rules_broken(link_rules.check, files)

    def test_links_to_files_folders_and_headings_are_allowed(self):
        self.assertEqual(self.broken(deploy__a=self.FILES["deploy/a.md"].replace("-1", "")), [])

    def test_a_link_to_no_file_is_found(self):
        self.assertEqual(self.broken(deploy__a="[back](README.md)"), [("deploy/a.md", "link")])

    def test_a_link_to_no_heading_is_found_in_this_and_in_another_document(self):
        self.assertEqual(self.broken(), [("deploy/a.md", "link")])
        for text in ("[x](#gone)", "[x](../README.md#no-heading)", "[x](b.md#an-end-2)"):
            self.assertEqual(self.broken(deploy__a=text), [("deploy/a.md", "link")], text)


if __name__ == "__main__":
    unittest.main()
