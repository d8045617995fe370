#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The long checks, in parts of at most an hour: tests/full.sh --list, tests/full.sh PART... What was
# stopped goes on where it was (tests/full/long_run.py).
set -euo pipefail
cd "$(dirname "$0")/.."
export VIEWLOOM_REQUIRE_GPU=1 VIEWLOOM_REQUIRE_NODE=1 VIEWLOOM_PIPELINE_WARM_UP=false
exec /usr/bin/python3 -B tests/full/main.py "$@"
