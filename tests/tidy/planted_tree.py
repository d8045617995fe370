# SPDX-License-Identifier: Apache-2.0
"""What a check finds in a small tree that a test makes up."""
from tree import Tree


def rules_broken(check, files):
    """Sorted (path, rule) of every finding in a tree of {path: text or bytes}."""
    tree = Tree({path: text if isinstance(text, bytes) else text.encode()
                 for path, text in files.items()})
    return sorted((finding.path, finding.rule) for finding in check(tree))
