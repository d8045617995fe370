# SPDX-License-Identifier: Apache-2.0
"""Help is taken apart whatever its words are, in both forms in which options may be written."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "deploy/manual"))
import bash_completion
import help_page
import man_page

HELP = """Sends things.

Usage: loom send [OPTIONS] [thing...]

Arguments:
  thing...                  Things to send

Options:
  -q, --quiet               Prints nothing
  --side {left,right}       Side to begin with
  --from NAME               Program that
                            wrote it
                            blue       the blue program
                            red, rose  one of the red ones
                            grey, black
                                       the others
  --a-name-that-is-long, --another LENGTH
                            In metres (default 1; not with
                            --quiet)
  --way fast|slow           How it is sent
  --what FILE|JSON          What is sent
  --mood MOOD               Mood to send in: calm, glad or sad (default calm)
  --rate HZ --quiet         A colon: is text or not

Examples:
  loom send a b             sends two

More is in the manual.
"""


class HelpPage(unittest.TestCase):
    def setUp(self):
        self.page = help_page.parse(["loom", "send"], HELP)
        self.options = {entry.names[-1]: entry for entry in self.page.options}

    def test_the_parts_are_found(self):
        self.assertEqual(self.page.usage, "loom send [OPTIONS] [thing...]")
        self.assertEqual(self.page.description, ["Sends things."])
        self.assertEqual([section.heading for section in self.page.sections],
                         ["Arguments", "Options", "Examples"])
        self.assertEqual(self.page.sections[2].verbatim,
                         ["  loom send a b             sends two"])
        self.assertEqual(self.page.remarks, ["More is in the manual."])

    def test_options_have_names_values_and_texts(self):
        self.assertEqual(list(self.options), ["--quiet", "--side", "--from", "--another",
                                              "--way", "--what", "--mood", "--rate"])
        self.assertEqual(self.options["--quiet"].names, ["-q", "--quiet"])
        self.assertEqual(self.options["--quiet"].value, "")
        self.assertEqual(self.options["--another"].value, "LENGTH")
        self.assertEqual(self.options["--another"].lines,
                         ["In metres (default 1; not with", "--quiet)"])

    def test_values_are_listed_in_four_ways(self):
        self.assertEqual({name: option.choices for name, option in self.options.items()
                          if option.choices},
                         {"--side": ["left", "right"], "--way": ["fast", "slow"],
                          "--mood": ["calm", "glad", "sad"],
                          "--from": ["blue", "red", "rose", "grey", "black"]})

    def test_the_older_form_is_read_as_well(self):
        page = help_page.parse(["loom"], "Usage: loom\n\nOptions:\n"
                               "  -h,--help                   Prints help\n"
                               "  --cube Excludes: --mirrors  A cube map\n"
                               "  --fps,--rate FLOAT:FLOAT in [0.001 - 1000] Excludes: --speed\n"
                               "                              Frames a second\n")
        self.assertEqual([(entry.names, bool(entry.value), entry.lines) for entry in page.options],
                         [(["-h", "--help"], False, ["Prints help"]),
                          (["--cube"], False, ["A cube map"]),
                          (["--fps", "--rate"], True, ["Frames a second"])])

    def test_tables_keep_their_columns_in_the_man_page(self):
        page = man_page.written(self.page, [self.page], "1", "2.0")
        self.assertIn("wrote it\n.nf\nblue       the blue program\nred, rose  one", page)
        self.assertIn("\\fB\\-q, \\-\\-quiet\\fR\nPrints nothing\n", page)

    def test_dots_and_backslashes_are_text(self):
        self.assertEqual(man_page.escaped(".a \\b -c"), "\\&.a \\eb \\-c")

    def test_bash_offers_the_listed_values(self):
        first = help_page.parse(["loom"], "Usage: loom\n\nCommands:\n  send   Sends\n")
        script = bash_completion.written([first, self.page])
        self.assertIn("'send --side') values='left right';;", script)


if __name__ == "__main__":
    unittest.main()
