// SPDX-License-Identifier: Apache-2.0
#include "bench/lens_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/log.h"
#include "bench/quality_lens.h"
#include "gpu/device.h"

namespace viewloom::bench {
namespace {

struct Arguments {
  std::filesystem::path folder;
  std::string device;
  LensWay way{.layer_count = 3, .walked_count = 8, .gathered_count = 32};
  LensScoring scoring{.source_width_px = 1200, .view_width_px = 400, .radius_m = 0.06};
};

// Of samples in 0..1, as portable pixmap.
void writePicture(const std::filesystem::path& path, SizePx size_px,
                  const std::vector<float>& srgb) {
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << size_px.width << " " << size_px.height << "\n255\n";
  for (const float sample : srgb) file.put(char(std::lround(255 * std::min(sample, 1.0F))));
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void writePictures(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const LensPictures pictures = lensPictures(device, arguments.scoring, arguments.way);
  std::filesystem::create_directories(arguments.folder);
  const auto write = [&](const char* name, const std::vector<float>& srgb) {
    writePicture(arguments.folder / name, pictures.size_px, srgb);
  };
  write("sharp.ppm", pictures.sharp);
  write("blurred.ppm", pictures.blurred);
  write("truth.ppm", pictures.truth);
}

}  // namespace

void addLensPicturesCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "lens-pictures", "Write what is seen without a lens, through one, and in truth, as PPM");
  command->add_option("folder", arguments->folder, "Where to")->required();
  command->add_option("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command->add_option("--walked", arguments->way.walked_count, "Rays a px that are walked");
  command->add_option("--gathered", arguments->way.gathered_count, "Rays that are gathered");
  command->add_option("--layers", arguments->way.layer_count, "Of the source, 1 to 3");
  command->add_option("--width", arguments->scoring.view_width_px, "Of the pictures, px");
  command->add_option("--radius", arguments->scoring.radius_m, "Of the lens, m");
  command->add_option("--aside", arguments->scoring.aside_m, "Right of the source, m");
  command->callback([arguments] { writePictures(*arguments); });
}

}  // namespace viewloom::bench
