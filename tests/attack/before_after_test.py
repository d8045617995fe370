# SPDX-License-Identifier: Apache-2.0
"""The table of two servers, with programs that stand for them."""

import contextlib
import io
import stat
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import before_after
import judge


class BeforeAfter(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def script(self, name, text):
        path = self.folder / name
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)

    def test_an_older_server_is_not_given_what_it_does_not_know(self):
        old = self.script("old", "#!/bin/sh\necho '  --http.address HOST:PORT  where'\n")
        settings = ("--http.allowed_hosts", "a.example", "--http.address", "127.0.0.1:0")
        self.assertEqual(before_after.known_settings(old, settings), settings[2:])

    def test_a_row_becomes_a_cell(self):
        row = judge.Row("ping", 9, 10.0, 0.5, 0.1, 64.4, 1.25, ["gap: 0.50 s"])
        output = f"{judge.HEADER}\n{row.text()}\n"
        self.assertEqual(before_after.cell_of(output, "ping"),
                         "9 of 10, 0 lost, 0.50 s, 64 MiB, 1.25 s; gap: 0.50 s")
        self.assertIsNone(before_after.cell_of(output, "settings"))

    def test_a_server_that_hangs_or_does_not_start_is_said(self):
        hung = self.script("hung.py", "import time\ntime.sleep(60)\n")
        self.assertEqual(before_after.measured("old", "ping", True, 0.5, hung),
                         "not over after 0 s")
        broken = self.script("broken.py", "raise RuntimeError('no picture')\n")
        self.assertEqual(before_after.measured("old", "ping", True, 20, broken),
                         "not measured: RuntimeError: no picture")

    def test_only_the_newer_server_is_judged(self):
        cells = {"old": "0 of 10, 9.00 s, 0 MiB, 0.00 s; gap", "new": "10 of 10; ok"}
        with unittest.mock.patch.object(before_after, "measured",
                                        lambda program, *_: cells[program]), \
                contextlib.redirect_stdout(io.StringIO()) as printed:
            self.assertTrue(before_after.table("old", "new", ["ping"], True))
            self.assertFalse(before_after.table("new", "old", ["ping"], True))
        self.assertIn("| ping | 0 of 10, 9.00 s, 0 MiB, 0.00 s; gap | 10 of 10; ok |",
                      printed.getvalue())


if __name__ == "__main__":
    unittest.main(verbosity=2)
