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
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/log.h"
#include "base/worker_pool.h"
#include "bench/knob_loads.h"
#include "bench/moving_frames.h"
#include "gpu/device.h"
#include "retime/frame_retimer.h"
#include "walk/offline_renderer.h"

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

// An application as its pictures show it.
struct Shown {
  std::string application;
  FramePtr input;
  FramePtr traced;
  DisplaySpec display;
  ScoredImage truth;
};

// Things carried on from one frame of a sequence to another, before a camera that stands.
Shown carriedThings() {
  constexpr uint32_t kLayers = 2;
  constexpr uint32_t kFrom = 8;
  constexpr uint32_t kTo = 12;
  const Sequence sequence = fastThings();
  const FramePtr input = frameOf(sequence, pictureOf(sequence, kFrom, kLayers), kFrom, kLayers);
  WorkerPool workers;
  FrameRetimer retimer(workers);
  const truth::Picture truth = pictureOf(sequence, kTo, 1);
  const CamerasSpec camera{
      .cameras = {{Pose{}, sequenceIntrinsics()}}, .tile_size_px = kSequence_px, .columns = 1};
  return {.application = "things",
          .input = input,
          .traced = retimer.retime(input, (kTo - kFrom) / kSequenceRate_hz, Guesses::kStand),
          .display = {.kind = camera, .world_pose = truth.camera.pose},
          .truth = imageOf(truth)};
}

std::vector<Shown> applications(uint32_t miniature) {
  std::vector<Shown> all;
  for (KnobLoad& load : knobLoads(miniature)) {
    all.push_back({.application = load.application,
                   .input = load.frame,
                   .traced = load.frame,
                   .display = load.display,
                   .truth = std::move(load.truth)});
  }
  all.push_back(carriedThings());
  return all;
}

void write(const std::filesystem::path& folder, OfflineRenderer& renderer, const Shown& shown) {
  const auto completed = completeDisplaySpec(shown.display);
  if (!completed.ok()) throw std::runtime_error(std::string(completed.status().message()));
  renderer.build(*shown.traced);
  const auto atlas = renderer.render(*completed, {.linear = true}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));

  const LayerPlanes& input = shown.input->sources.front().front();
  VIEWLOOM_CHECK(input.color_encoding == PlaneEncoding::kRgba8);
  const auto path = [&](const char* what) {
    return folder / (shown.application + "-" + what + ".ppm");
  };
  writePicture(path("input"), shown.input->format.sources.front().layers.front().color.size_px,
               [&](size_t px, size_t channel) { return (*input.color)[4 * px + channel]; });
  writePicture(path("result"), atlas->layout->size_px,
               [&](size_t px, size_t channel) { return codeOf(atlas->linear[4 * px + channel]); });
  writePicture(path("truth"), shown.truth.size_px, [&](size_t px, size_t channel) {
    return codeOf(shown.truth.rgb[3 * px + channel]);
  });
}

void writePictures(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  OfflineRenderer renderer(device);
  std::filesystem::create_directories(arguments.folder);
  for (const Shown& shown : applications(arguments.miniature)) {
    write(arguments.folder, renderer, shown);
  }
}

}  // namespace

void addPicturesCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "pictures", "Write input, result and truth of each application of the tracer, as PPM");
  command.add("folder", arguments->folder, "Where to").required();
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command
      .add("--miniature", arguments->miniature,
           "Frames and displays so many times smaller on a side: tries the program out")
      .between(1, 8);
  command.onChosen([arguments] { writePictures(*arguments); });
}

}  // namespace viewloom::bench
