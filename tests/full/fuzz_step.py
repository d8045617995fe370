# SPDX-License-Identifier: Apache-2.0
"""fuzz_step.py BUILD KEPT TARGET SECONDS: searches a target until it was searched enough: 10
million executions, or 2 hours of CPU time. Says every SECONDS how far it has come, and keeps it.

BUILD is the folder of the build. The corpus grows in KEPT/corpus/TARGET, the progress is in
KEPT/progress/TARGET.json, and an input that failed comes to KEPT/failed. All processors search the
same corpus.
"""

import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

from fuzz_record import FuzzRecord, Searched
from fuzz_sources import FuzzSources

ROOT = pathlib.Path(__file__).parents[2]
# Longer inputs find little more, and take long.
BYTES_MAX = 16384
OPTIONS = ["-timeout=30", "-rss_limit_mb=4096", f"-max_len={BYTES_MAX}", "-print_final_stats=1",
           # For each feature of an input, that schedule looks through all rare features: two
           # thirds of the time of `calls`, half of that of `frame`.
           "-entropic=0",
           # Starts a program that reads all symbols, for names that nobody sees here.
           "-print_funcs=0"]
# Freed memory that waits longer misses the caches; 16 MB are that of several executions. A call
# stack of each allocation costs more the longer it is. Whoever runs a failed input by hand gets
# whole ones.
SANITIZERS = {"ASAN_OPTIONS": "quarantine_size_mb=16:malloc_context_size=5"}
STATISTIC = re.compile(rb"^stat::number_of_executed_units:\s+(\d+)$", re.MULTILINE)


def executed(output):
    """The number of executions that libFuzzer prints at its end."""
    found = STATISTIC.findall(output)
    return int(found[-1]) if found else 0


def run_all(commands, environment):
    """(status, output on stderr) of each, side by side."""
    running = []
    for command in commands:
        output = tempfile.TemporaryFile()
        running.append((subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=output,
                                         env=environment), output))
    ended = []
    for process, output in running:
        status = process.wait()
        with output:
            output.seek(0)
            ended.append((status, output.read()))
    return ended


def search(build, kept, target, seconds):
    """What was searched, and the first exit status that is not 0."""
    corpus, failed = kept / "corpus" / target, kept / "failed"
    for folder in (corpus, failed):
        folder.mkdir(parents=True, exist_ok=True)
    command = [build / "tests/fuzz" / f"{target}_fuzzer", f"-max_total_time={seconds}", *OPTIONS,
               f"-artifact_prefix={failed}/{target}-", corpus]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = run_all([command] * os.cpu_count(), {**SANITIZERS, **os.environ})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    for status, output in ended:
        if status != 0:
            sys.stderr.buffer.write(output[-20_000:])
    statuses = [status for status, _ in ended if status != 0]
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    count = sum(executed(output) for _, output in ended)
    return Searched(count, cpu_s, len(statuses)), statuses[0] if statuses else 0


def main(words):
    build, kept, target, seconds = pathlib.Path(words[0]), pathlib.Path(words[1]), *words[2:]
    record, state = FuzzRecord(kept, target), FuzzSources(ROOT).state_of(target)
    while record.of_state(state).share() < 1:
        searched, status = search(build, kept, target, seconds)
        record.add(state, searched)
        print(f"{target}: {record.of_state(state).text()}", flush=True)
        if status != 0:
            return status
        if searched.executions == 0:
            print(f"{target}: nothing was executed; look at the output of its fuzzer",
                  file=sys.stderr)
            return 1
    print(f"{target}: searched enough, {record.of_state(state).text()}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
