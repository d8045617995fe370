# SPDX-License-Identifier: Apache-2.0
"""The parts of the long checks."""

import json
import os
import pathlib
import re
import subprocess
import sys

from fuzz_record import CPU_S, EXECUTIONS
from fuzz_sources import FuzzSources
from long_run import Part, Step

JOBS = str(os.cpu_count())
ROOT = pathlib.Path(__file__).parents[2]
FUZZERS = FuzzSources(ROOT).targets()
# Corpora, and how far the search has come. A folder that outlives the build keeps them.
FUZZ_KEPT = os.environ.get("VIEWLOOM_FUZZ_KEPT", "build/fuzz")
# How often a search keeps how far it has come.
FUZZ_SLICE_S = 120
# Beyond those of the suite. A seed of several sources takes longer than one of a single source.
SOAKS = {"walk": ([], 200, 40), "sweep": (["sweep"], 2000, 20), "cube": (["cube"], 100, 20),
         "sources": (["sources"], 100, 20), "beside": (["beside"], 100, 20)}
FIRST_SEED = 100_000
TERMINATIONS, TERMINATIONS_A_STEP = 100, 10
FAULT_SEEDS = 5


def build(preset, *targets):
    return [Step(f"configure {preset}", ["cmake", "--preset", preset]),
            Step(f"build {preset}", ["cmake", "--build", f"build/{preset}", "--parallel", JOBS,
                                     *(["--target", *targets] if targets else [])])]


def ctest(preset, label):
    """All tests of a label, several at a time."""
    return lambda: [Step(f"tests of {label}",
                         ["ctest", "--test-dir", f"build/{preset}", "--parallel", JOBS, "-L",
                          f"^{label}$", "--no-tests=error", "--output-on-failure"])]


def each_ctest(preset, label):
    """One step for each test of a label, so that they can be stopped in between."""
    def steps():
        shown = subprocess.run(["ctest", "--test-dir", f"build/{preset}", "-L", f"^{label}$",
                                "--show-only=json-v1"], check=True, capture_output=True).stdout
        return [Step(test["name"], ["ctest", "--test-dir", f"build/{preset}", "-R",
                                    f"^{re.escape(test['name'])}$", "--output-on-failure"])
                for test in json.loads(shown)["tests"]]
    return steps


def fuzz(name):
    """One step: what it has covered is kept by itself, whatever else of the sources changes."""
    seeds = Step("seeds", ["build/fuzz/tests/fuzz/write_seeds", name, f"{FUZZ_KEPT}/corpus/{name}"])

    def steps():
        return [Step(f"search of {FuzzSources(ROOT).state_of(name)}",
                     [sys.executable, "tests/full/fuzz_step.py", "build/fuzz", FUZZ_KEPT, name,
                      str(FUZZ_SLICE_S)])]
    return Part(f"fuzz-{name}", f"libFuzzer: {EXECUTIONS // 1_000_000} million executions or "
                f"{CPU_S // 3600} CPU hours; keeps the corpus", "searches", steps,
                build("fuzz", "fuzzers") + [seeds])


def soak(name):
    words, count, step_count = SOAKS[name]
    return Part(f"seeds-{name}", "random scenes beside the oracle", "seeds",
                lambda: [Step(f"seeds from {first}",
                              ["build/release/tests/gpu/viewloom-oracle-soak", *words, str(first),
                               str(count)], count)
                         for first in range(FIRST_SEED, FIRST_SEED + count * step_count, count)],
                build("release", "viewloom-oracle-soak"))


def attack():
    """Each form is a step; the fronts have to be installed."""
    words = ["env", "PYTHONPATH=build/release/client/python", sys.executable,
             "tests/attack/main.py", "build/release/server/viewloomd"]
    return Part("attack", "attacks beside a healthy pair, at their full length; needs haproxy and "
                "nginx", "forms",
                lambda: [Step("the server alone", words),
                         *(Step(f"behind {front}", [*words, "--front", front])
                           for front in ("haproxy", "nginx"))],
                build("release", "viewloomd", "viewloom_python"))


def overload():
    """Each figure is a step; SIGTERM at random moments takes some more."""
    words = ["env", "PYTHONPATH=build/release/client/python", sys.executable,
             "tests/overload/overload.py", "build/release/server/viewloomd"]
    return Part("overload", "overloads beside a healthy pair; 100 random moments of SIGTERM; on "
                "a quiet machine", "figures",
                lambda: [*(Step(figure, [*words, figure])
                           for figure in ("beside", "slow_viewers", "overcommit")),
                         *(Step(f"terminations from {first}",
                                [*words, "terminations", "--first", str(first), "--count",
                                 str(TERMINATIONS_A_STEP)])
                           for first in range(0, TERMINATIONS, TERMINATIONS_A_STEP))],
                build("release", "viewloomd", "viewloom_python"))


def lasting():
    """Each form is a server of its own: its heap cannot go on after a stop."""
    paths = "build/release/client/python:tests/attack:tests/atlases"
    words = ["env", f"PYTHONPATH={paths}", sys.executable, "tests/soak/main.py",
             "build/release/server/viewloomd"]
    library = os.path.abspath("build/release/tests/soak/libviewloom_planted_fault.so")
    return Part("soak", "what a server loses while clients come and go; planted losses are found",
                "minutes",
                lambda: [Step("10 minutes", words, 10),
                         Step("10 minutes that lose 16 bytes a connection",
                              [*words, "--plant", library, "heap:16"], 10),
                         Step("an hour", [*words, "--hour"], 60),
                         Step("an hour with encryption and tokens",
                              [*words, "--hour", "--protected"], 60)],
                build("release", "viewloomd", "viewloom_python", "viewloom_planted_fault"))


def vulkan_faults():
    """Each stage of a server's life is a step, and so are ten random calls."""
    python = ["env", "PYTHONPATH=build/release/client/python", sys.executable]
    command = [*python, "tests/vulkan_faults/main.py", "build/release/server/viewloomd",
               "build/release/tests/vulkan_faults/layers"]

    def steps():
        names = subprocess.run([*python, "tests/vulkan_faults/stages.py"], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        return ([Step(name, [*command, "--stage", name]) for name in names] +
                [Step(f"random calls {seed}",
                      [*command, "--sites", "10", "--seed", str(seed)], 10)
                 for seed in range(1, FAULT_SEEDS + 1)])
    return Part("vulkan-faults", "each function of Vulkan fails in each stage, and 50 random calls",
                "stages and calls", steps,
                build("release", "viewloomd", "viewloom_fault_layer", "viewloom_python"))


def compare():
    """Builds the commit VIEWLOOM_COMPARE_WITH beside this one."""
    before = os.path.abspath("build/before")
    commit = os.environ.get("VIEWLOOM_COMPARE_WITH", "HEAD~1")
    checkout = (f"test -d {before} || git worktree add --detach {before} {commit}; "
                f"git -C {before} checkout --detach \"$(git rev-parse {commit})\"")
    build_before = (f"cd {before} && cmake --preset release && cmake --build build/release "
                    f"--parallel {JOBS} --target viewloom viewloomd viewloom_python")
    return Part("compare", f"every picture of this build and of {commit}, byte by byte", "runs",
                lambda: [Step("all scenes", ["env", "PYTHONPATH=build/release/client/python",
                                             sys.executable, "tests/atlases/compare_builds.py",
                                             f"{before}/build/release", "build/release"])],
                [Step("check out the commit before", ["bash", "-ec", checkout]),
                 Step("build the commit before", ["bash", "-ec", build_before])]
                + build("release", "viewloom", "viewloomd", "viewloom_python"))


PARTS = [
    Part("address-unit", "unit tests under address and undefined-behaviour sanitizers", "runs",
         ctest("asan", "unit"), build("asan", "unit_tests")),
    Part("address-gpu", "device tests under the same", "tests", each_ctest("asan", "gpu"),
         build("asan")),
    Part("address-e2e", "servers and clients under the same", "tests", each_ctest("asan", "e2e"),
         build("asan")),
    Part("threads", "unit tests under the thread sanitizer", "runs", ctest("tsan", "unit"),
         build("tsan", "unit_tests")),
    *map(fuzz, FUZZERS),
    Part("fuzz-coverage", "lines of parsers and checks that the corpora reach; after the others",
         "runs", lambda: [Step("all corpora", [sys.executable, "tests/full/fuzz_coverage.py",
                                               "build/fuzz-coverage", f"{FUZZ_KEPT}/corpus"])],
         build("fuzz-coverage", "fuzzers")),
    *map(soak, SOAKS),
    Part("lint", "clang-tidy over server and client", "runs",
         lambda: [Step("clang-tidy", ["cmake", "--build", "build/lint", "--target", "clang_tidy"])],
         build("lint", "generated_headers")),
    Part("hardware-video", "encoders of libavcodec, x264 in place of a GPU; needs "
         "deploy/setup.sh --hardware-video", "runs",
         lambda: [Step("tests of video", ["ctest", "--preset", "hardware-video"])],
         build("hardware-video")),
    attack(),
    overload(),
    lasting(),
    vulkan_faults(),
    compare(),
    Part("bare-system", "packages, build and first picture in a bare Debian 12 (as root)", "runs",
         lambda: [Step("debootstrap to picture", ["tests/full/bare_system.sh"])]),
    Part("container", "the image of deploy/Containerfile, by podman or docker", "runs",
         lambda: [Step("build to health", ["tests/full/container.sh"])]),
    Part("packages", "Debian packages, installed in a bare Debian 12 (as root)", "runs",
         lambda: [Step("packages to picture", ["tests/full/bare_packages.sh"])]),
]
