# SPDX-License-Identifier: Apache-2.0
"""Every command of one document works as it stands there: document_test.py BUILD DOCUMENT.

Short forms are in short_forms.py, the reader's own files in samples.py. What runs beside the
commands is in served.py.
"""

import pathlib
import signal
import sys

from document_run import DocumentRun
from running import cpu_seconds

ROOT = pathlib.Path(__file__).parents[2]
SKIPPED = 77  # as CMakeLists.txt says


def main(build, document):
    # Ends as an exception does, so that everything that was started is stopped.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))
    run = DocumentRun(document, (ROOT / document).read_text(encoding="utf-8"), ROOT, build)
    problems = [*run.check_names(), *run.run()]
    for _, form in dict.fromkeys(run.used):
        print(f"short form: {form.pattern} -> {form.instead} ({form.why})")
    print(f"{document}: " + ", ".join(f"{count} {name}" for name, count in run.counts.items())
          + f" blocks; CPU {cpu_seconds():.1f} s")
    for problem in problems:
        print(f"\nFAILED {problem}")
    if run.skipped and not problems:
        print(f"skipped, and VIEWLOOM_REQUIRE_NODE=1 makes it a failure: {run.skipped}")
        return SKIPPED
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
