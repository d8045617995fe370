// SPDX-License-Identifier: Apache-2.0
// Writes the seeds as a corpus: write_seeds jpeg|zstd|predicted|frame|picture FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "fuzz/seeds.h"

int main(int argc, char** argv) {
  const std::string kind = argc == 3 ? argv[1] : "";
  const viewloom::SeedBytes seeds = kind == "jpeg"        ? viewloom::jpegSeeds()
                                    : kind == "zstd"      ? viewloom::zstdSeeds()
                                    : kind == "predicted" ? viewloom::predictedSeeds()
                                    : kind == "frame"     ? viewloom::frameSeeds()
                                    : kind == "picture"   ? viewloom::pictureSeeds()
                                                          : viewloom::SeedBytes{};
  if (seeds.empty()) {
    std::fprintf(stderr, "usage: write_seeds jpeg|zstd|predicted|frame|picture FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder(argv[2]);
  std::filesystem::create_directories(folder);
  for (size_t i = 0; i < seeds.size(); ++i) {
    std::ofstream file(folder / ("seed-" + std::to_string(i)), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seeds[i].data()),
               static_cast<std::streamsize>(seeds[i].size()));
  }
  return 0;
}
