# SPDX-License-Identifier: Apache-2.0
"""A version that stands in a second place is found, wherever that is."""
import unittest

import version_rules
from planted_tree import rules_broken

# In halves, so that the rule does not find its own test.
NOW, BEFORE, OTHER = "3." "1.4", "3." "1.3", "9." "8.7"
CLEAN = {"CMakeLists.txt": f"project(viewloom VERSION {NOW} LANGUAGES C CXX)\n",
         "CHANGELOG.md": f"# Changes\n\n## Unreleased\n\n## {NOW} (2026-01-01)\n\n## {BEFORE}\n"}


class Versions(unittest.TestCase):
    def broken(self, **files):
        named = {name.replace("__", "/").replace("_at_", "."): text
                 for name, text in files.items()}
        return [path for path, rule in rules_broken(version_rules.check, {**CLEAN, **named})
                if rule == "version"]

    def test_a_tree_that_says_it_once_is_clean(self):
        self.assertEqual(self.broken(), [])

    def test_the_newest_section_of_the_changes_must_be_of_the_version(self):
        for text in (f"## {BEFORE}\n", f"## {BEFORE}\n## {NOW}\n", "## Unreleased\n", ""):
            self.assertEqual(self.broken(CHANGELOG_at_md=text), ["CHANGELOG.md"], text)

    def test_a_project_without_a_version_is_found(self):
        self.assertEqual(self.broken(CMakeLists_at_txt="project(viewloom)\n"), ["CMakeLists.txt"])

    def test_the_version_and_earlier_ones_are_found_in_other_files(self):
        for text in (f"viewloom {NOW}\n", f"v{NOW}.\n", f"install viewloomd_{NOW}_amd64.deb\n",
                     f"viewloom-{NOW}-py3-none-any.whl\n", f"since {BEFORE}, it\n"):
            self.assertEqual(self.broken(deploy__README_at_md=text), ["deploy/README.md"], text)

    def test_versions_of_others_and_addresses_are_free(self):
        for text in (f"Mesa {OTHER}\n", f"127.{NOW}\n", f"1{NOW}\n", f"{NOW}5\n", f"{NOW}.2\n"):
            self.assertEqual(self.broken(deploy__README_at_md=text), [], text)

    def test_a_description_of_a_package_says_no_version_at_all(self):
        self.assertEqual(self.broken(a__package_at_json=f'{{\n  "version": "{OTHER}"\n}}\n'),
                         ["a/package.json"])
        self.assertEqual(self.broken(a__pyproject_at_toml=f'version = "{OTHER}"\n'),
                         ["a/pyproject.toml"])
        self.assertEqual(self.broken(a__pyproject_at_toml='version = "@PROJECT_VERSION@"\n'), [])

    def test_a_lock_has_versions_of_others_alone(self):
        lock = '{%s"packages": {"": {%s}, "node_modules/a": {"version": "' + NOW + '"}}}'
        said = f'"version": "{OTHER}"'
        path = "a/package-lock.json"
        self.assertEqual(self.broken(**{path: lock % ("", "")}), [])
        self.assertEqual(self.broken(**{path: lock % (said + ", ", "")}), [path])
        self.assertEqual(self.broken(**{path: lock % ("", said)}), [path])


if __name__ == "__main__":
    unittest.main()
