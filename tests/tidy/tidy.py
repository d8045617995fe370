# SPDX-License-Identifier: Apache-2.0
"""Reads the repository and says which of its own rules it breaks: one line each, exit code 1.

tidy.py ROOT                     checks
tidy.py ROOT --graph FILE        draws which folder includes which instead, as .dot or .svg
"""

import sys

import build_rules
import coroutine_rules
import file_lengths
import include_graph
import language_rules
import layering
import link_rules
import proto_rules
import reference_rules
import schedule_rules
import text_rules
import user_texts
import version_rules
from tree import Tree


def main():
    tree = Tree.of_repository(sys.argv[1])
    if sys.argv[2:3] == ["--graph"]:
        include_graph.write(tree, sys.argv[3])
        return 0
    findings = sorted(finding for rules in (build_rules, coroutine_rules, include_graph,
                                            language_rules, layering, link_rules, proto_rules,
                                            reference_rules, schedule_rules, text_rules, user_texts,
                                            version_rules)
                      for finding in rules.check(tree))
    for finding in findings:
        print(finding)
    print(file_lengths.summary(tree))
    print(f"{len(tree.paths())} files read, {len(findings)} findings")
    return 1 if findings or not tree.paths() else 0


if __name__ == "__main__":
    sys.exit(main())
