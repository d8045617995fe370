// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of a target as a corpus.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "fuzz/fuzz_target.h"

int main(int argc, char** argv) {
  const viewloom::FuzzTarget* const target =
      argc == 3 ? viewloom::findFuzzTarget(argv[1]) : nullptr;
  if (target == nullptr) {
    std::fprintf(stderr, "usage: write_seeds TARGET FOLDER; the targets are:\n");
    for (const viewloom::FuzzTarget& known : viewloom::fuzzTargets()) {
      std::fprintf(stderr, "  %s\n", std::string(known.name).c_str());
    }
    return 2;
  }
  const std::filesystem::path folder(argv[2]);
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const std::vector<uint8_t>& seed : target->seeds()) {
    std::ofstream file(folder / ("seed-" + std::to_string(number++)), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seed.data()),
               static_cast<std::streamsize>(seed.size()));
  }
  return 0;
}
