// SPDX-License-Identifier: Apache-2.0
#include "bench/application_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/log.h"
#include "bench/knob_loads.h"
#include "commands/offline_renderer.h"
#include "gpu/device.h"

namespace viewloom::bench {
namespace {

struct Arguments {
  std::filesystem::path folder;
  std::string device;
  uint32_t miniature = 1;
};

// `code_at(px, channel)`: 0..255. As portable pixmap.
template <typename CodeAt>
void writePicture(const std::filesystem::path& path, SizePx size_px, const CodeAt& code_at) {
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << size_px.width << " " << size_px.height << "\n255\n";
  for (size_t px = 0; px < size_px.area(); ++px) {
    for (size_t channel = 0; channel < 3; ++channel) file.put(char(code_at(px, channel)));
  }
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

uint8_t codeOf(float srgb) {
  return uint8_t(std::lround(255 * std::clamp(srgb, 0.0F, 1.0F)));
}

void writeLoad(const std::filesystem::path& folder, OfflineRenderer& renderer,
               const KnobLoad& load) {
  const auto completed = completeDisplaySpec(load.display);
  if (!completed.ok()) throw std::runtime_error(std::string(completed.status().message()));
  renderer.build(*load.frame);
  const auto atlas = renderer.render(*completed, {.linear = true}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));

  const LayerPlanes& input = load.frame->sources.front().front();
  VIEWLOOM_CHECK(input.color_encoding == PlaneEncoding::kRgba8);
  const auto path = [&](const char* what) {
    return folder / (load.application + "-" + what + ".ppm");
  };
  writePicture(path("input"), load.frame->format.sources.front().layers.front().color.size_px,
               [&](size_t px, size_t channel) { return (*input.color)[4 * px + channel]; });
  writePicture(path("result"), atlas->layout->size_px, [&](size_t px, size_t channel) {
    return codeOf(atlas->linear[4 * px + channel]);
  });
  writePicture(path("truth"), load.truth.size_px, [&](size_t px, size_t channel) {
    return codeOf(load.truth.rgb[3 * px + channel]);
  });
}

void writePictures(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  OfflineRenderer renderer(device);
  std::filesystem::create_directories(arguments.folder);
  for (const KnobLoad& load : knobLoads(arguments.miniature)) {
    writeLoad(arguments.folder, renderer, load);
  }
}

}  // namespace

void addPicturesCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "pictures", "Write input, result and truth of each application of the tracer, as PPM");
  command->add_option("folder", arguments->folder, "Where to")->required();
  command->add_option("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command
      ->add_option("--miniature", arguments->miniature,
                   "Frames and displays so many times smaller on a side: tries the program out")
      ->check(CLI::Range(1, 8));
  command->callback([arguments] { writePictures(*arguments); });
}

}  // namespace viewloom::bench
