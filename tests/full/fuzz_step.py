# SPDX-License-Identifier: Apache-2.0
"""fuzz_step.py FOLDER TARGET SOURCE SECONDS: searches a target for a while, unless it was searched
enough: 10 million executions, or 2 hours of CPU time. Says how far it has come.

FOLDER is that of the build. The corpus grows in FOLDER/corpus/TARGET. The progress for one state of
the sources, named SOURCE, is kept in FOLDER/progress/TARGET.json.
"""

import json
import pathlib
import re
import resource
import subprocess
import sys

EXECUTIONS = 10_000_000
CPU_S = 2 * 3600
# Longer inputs find little more, and take long.
BYTES_MAX = 16384
STATISTIC = re.compile(rb"^stat::number_of_executed_units:\s+(\d+)$", re.MULTILINE)


class Progress:
    """How long the sources were searched, in a file."""

    def __init__(self, file, source):
        self._file = pathlib.Path(file)
        self._source = source
        self.executions, self.cpu_s = 0, 0.0
        if self._file.exists():
            kept = json.loads(self._file.read_text())
            if kept["source"] == source:
                self.executions, self.cpu_s = kept["executions"], kept["cpu_s"]

    def is_enough(self):
        return self.executions >= EXECUTIONS or self.cpu_s >= CPU_S

    def add(self, executions, cpu_s):
        self.executions += executions
        self.cpu_s += cpu_s
        self._file.parent.mkdir(parents=True, exist_ok=True)
        temporary = self._file.with_suffix(".new")
        temporary.write_text(json.dumps({"source": self._source, "executions": self.executions,
                                         "cpu_s": round(self.cpu_s, 1)}))
        temporary.replace(self._file)

    def text(self):
        return f"{self.executions:,} executions in {self.cpu_s / 60:.0f} CPU minutes"


def executed(output):
    """The number of executions that libFuzzer prints at its end."""
    found = STATISTIC.findall(output)
    return int(found[-1]) if found else 0


def search(folder, target, seconds):
    """Executions, CPU seconds and exit status of one search."""
    corpus = folder / "corpus" / target
    corpus.mkdir(parents=True, exist_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [folder / "tests/fuzz" / f"{target}_fuzzer", f"-max_total_time={seconds}", "-timeout=30",
         "-rss_limit_mb=4096", f"-max_len={BYTES_MAX}", "-print_final_stats=1",
         f"-artifact_prefix={folder}/{target}-", corpus],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.stderr.buffer.write(done.stderr[-20_000:])
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return executed(done.stderr), cpu_s, done.returncode


def main(words):
    folder, target, source, seconds = pathlib.Path(words[0]), words[1], words[2], words[3]
    progress = Progress(folder / "progress" / f"{target}.json", source)
    if progress.is_enough():
        print(f"{target}: searched enough, {progress.text()}")
        return 0
    executions, cpu_s, status = search(folder, target, seconds)
    if status == 0:
        progress.add(executions, cpu_s)
        print(f"{target}: {progress.text()}")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
