# SPDX-License-Identifier: Apache-2.0
"""A metric, a setting or an address that its document leaves out is found, and one that is gone."""
import unittest

import reference_rules
from planted_tree import rules_broken

METRICS = '''const LabelValues kWays = {"there",
                           "back"};
counter(registry, "viewloom_frames_total", "Frames.")
counters(registry, "viewloom_trips_total", "Trips.", "way", kWays)
'''
SETTINGS = '''{"device", "", "Device to use", TextSetting{}},
{"grpc.keepalive_s", "s",
 "Silence before a ping", CountSetting{}},
'''
OPERATIONS = '''inline constexpr std::string_view kList = "/viewloom.v1.CatalogService/ListStreams";
inline constexpr std::string_view kWebSocket = "/ws";
inline constexpr std::string_view kStills = "/still/";
inline constexpr std::string_view kHealthPage = "/healthz";
'''
SETTINGS_PAGE = '''# Settings and limits
## Settings
| Setting | Default |
|---|---|
| `device` | `""` |
| `grpc.keepalive_s` | 10 |
## Limits
| `other` | 1 |
'''
METRICS_PAGE = '''# Health and metrics
| `http://HOST/healthz` | 200 |
## Metrics
| `viewloom_frames_total` | counter |
| `viewloom_trips_total{way}` | `there`, `back` |
## Questions
| Is it fast? | yes |
'''
WEB_PAGE = '''## Addresses
| `/` | the page |
| `/healthz` | 200 |
| `/still/STREAM/PRESET` | a picture |
| `/ws?stream=STREAM&...` | atlases |
### Which display
| `stream` | a name |
'''
CLEAN = {"server/metrics/metrics.cpp": METRICS, "server/config/settings.cpp": SETTINGS,
         "server/access/operations.h": OPERATIONS,
         "deploy/settings.md": SETTINGS_PAGE, "deploy/metrics.md": METRICS_PAGE,
         "proto/web.md": WEB_PAGE}


class References(unittest.TestCase):
    def broken(self, path, before, after):
        self.assertIn(before, CLEAN[path])
        changed = {**CLEAN, path: CLEAN[path].replace(before, after)}
        return rules_broken(reference_rules.check, changed)

    def test_documents_that_name_all_are_clean(self):
        self.assertEqual(rules_broken(reference_rules.check, CLEAN), [])

    def test_what_the_code_adds_is_found(self):
        for path, before, more in (
                ("server/metrics/metrics.cpp", "counter(",
                 'counter(registry, "viewloom_new_total", "New.")\n'),
                ("server/metrics/metrics.cpp", '"back"', '"aside", '),
                ("server/config/settings.cpp", '{"device"', '{"log.level", "", "Level"}, '),
                ("server/access/operations.h", "inline",
                 'inline constexpr std::string_view kNew = "/api/new";\n')):
            self.assertEqual(self.broken(path, before, more + before), [(path, "reference")], more)

    def test_what_a_document_leaves_out_is_found_in_the_code(self):
        for document, row, path in (
                ("deploy/metrics.md", "| `viewloom_frames_total` | counter |\n",
                 "server/metrics/metrics.cpp"),
                ("deploy/settings.md", "| `grpc.keepalive_s` | 10 |\n",
                 "server/config/settings.cpp"),
                ("proto/web.md", "| `/still/STREAM/PRESET` | a picture |\n",
                 "server/access/operations.h"),
                ("proto/web.md", "| `/ws?stream=STREAM&...` | atlases |\n",
                 "server/access/operations.h")):
            self.assertEqual(self.broken(document, row, ""), [(path, "reference")], row)

    def test_what_is_gone_is_found_in_the_document(self):
        for document, before, row in (
                ("deploy/metrics.md", "## Questions",
                 "| `viewloom_gone_total` | counter |\n## Questions"),
                ("deploy/settings.md", "## Limits", "| `gone.setting` | 1 |\n## Limits"),
                ("proto/web.md", "### Which", "| `/api/gone` | a list |\n### Which")):
            self.assertEqual(self.broken(document, before, row), [(document, "reference")], row)


if __name__ == "__main__":
    unittest.main()
