# SPDX-License-Identifier: Apache-2.0
"""The drawn include graph and the counted file lengths are those of small made-up trees."""
import unittest

import file_lengths
import include_graph
from planted_tree import rules_broken
from tree import Tree

# Files of three folders, each of which includes the next.
CHAIN = {"server/rpc/a.h": b'#include "publish/a.h"\n#include "base/a.h"\n',
         "server/publish/a.h": b'#include "base/a.h"\n', "server/core/base/a.h": b""}


class FileLengths(unittest.TestCase):
    def test_the_median_the_90th_percentile_and_short_files_are_counted(self):
        tree = Tree({f"{length}.{suffix}": b"x\n" * length
                     for length, suffix in [(10, "cpp"), (39, "h"), (40, "glsl"), (90, "comp"),
                                            (100, "cpp"), (1000, "py")]})
        self.assertEqual(file_lengths.summary(tree), "5 files of C++ and GLSL: median 40 lines, "
                         "90th percentile 100, 2 under 40")


class IncludeGraph(unittest.TestCase):
    def graph(self, **files):
        return include_graph.arrows(Tree({**CHAIN, **files}))

    def test_each_folder_is_above_what_it_includes(self):
        self.assertEqual(include_graph.rows(self.graph()),
                         [["server/core/base"], ["server/publish"], ["server/rpc"]])

    def test_an_arrow_that_follows_from_others_is_not_drawn(self):
        graph = self.graph()
        self.assertIn(("server/rpc", "server/core/base"), graph)
        self.assertEqual(include_graph.drawn(graph), [("server/publish", "server/core/base"),
                                                      ("server/rpc", "server/publish")])
        self.assertIn('"server/rpc" -> "server/publish";', include_graph.dot(graph))
        self.assertEqual(include_graph.svg(graph).count("<line"), 2)

    def test_a_cycle_is_found_where_it_begins(self):
        upwards = {"server/core/base/b.h": '#include "rpc/a.h"\n'}
        self.assertEqual(rules_broken(include_graph.check, {**CHAIN, **upwards}),
                         [("server/core/base/b.h", "cycle")])
        self.assertEqual(rules_broken(include_graph.check, CHAIN), [])


if __name__ == "__main__":
    unittest.main()
