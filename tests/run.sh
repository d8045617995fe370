#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds everything and runs every test. Arguments go to ctest (-L unit).
set -euo pipefail
cd "$(dirname "$0")/.."

# A machine without a Vulkan device must not pass by skipping: lavapipe is always there.
export VIEWLOOM_REQUIRE_GPU=1
export CTEST_OUTPUT_ON_FAILURE=1
# Servers of tests live for seconds: to compile kernels that nobody asks for would take the cores from
# the tests.
export VIEWLOOM_PIPELINE_WARM_UP=false
jobs="$(nproc)"

minutes() { printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); }

SECONDS=0
deploy/setup.sh --dev
install_s=$SECONDS

SECONDS=0
cmake --preset release -DVIEWLOOM_TESTS=ON
cmake --build build/release --parallel "$jobs" --target all all_verify_interface_header_sets
build_s=$SECONDS

SECONDS=0
result=0
ctest --test-dir build/release --parallel "$jobs" --no-tests=error "$@" || result=$?
test_s=$SECONDS

echo
echo "install $(minutes $install_s), build $(minutes $build_s), test $(minutes $test_s)" \
  "on $jobs cores"
if [[ $result -eq 0 ]]; then
  echo "viewloom: every test passed"
else
  echo "viewloom: tests FAILED; their output is in build/release/Testing/Temporary/LastTest.log" >&2
fi
exit $result
