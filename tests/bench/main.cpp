// SPDX-License-Identifier: Apache-2.0
// viewloom-bench: viewloom beside its rivals, in one process, on the same frames.
#include <exception>
#include <iostream>

#include "bench/bench_commands.h"

int main(int argc, char** argv) {
  try {
    return viewloom::bench::runBench(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "viewloom-bench: " << error.what() << "\n";
    return 1;
  }
}
