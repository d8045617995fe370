// SPDX-License-Identifier: Apache-2.0
#include "bench/retime_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/report.h"
#include "messages/display_from_proto.h"
#include "offline/manifest_frame.h"
#include "offline/median.h"
#include "offline/stage_bench.h"
#include "retime/frame_retimer.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kLayers = 2;
// Time after the frame, s: half way between frames of 15 Hz.
constexpr double kCarried_s = 1.0 / 30;
constexpr float kSpeed_mps[3] = {0.5F, 0.25F, 0.125F};  // binary16 each

struct Arguments {
  std::string device;
  uint32_t round_count = 5;
  uint32_t miniature = 1;
  bool prints_json = false;
};

template <typename Work>
double timedMs(const Work& work) {
  const auto started = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started)
      .count();
}

Json measureShare(const Device& device, const Frame& still, double share, uint32_t round_count) {
  const FramePtr frame = withMotion(still, share);
  WorkerPool workers;
  FrameRetimer retimer(workers);
  FramePtr retimed = retimer.retime(frame, kCarried_s);
  std::vector<double> first_ms, next_ms;
  for (uint32_t i = 0; i < round_count; ++i) {
    const auto copy = std::make_shared<const Frame>(*frame);  // another one: links are made anew
    first_ms.push_back(timedMs([&] { retimed = retimer.retime(copy, kCarried_s); }));
    next_ms.push_back(timedMs([&] { retimed = retimer.retime(copy, 0.5 * kCarried_s); }));
  }
  v1::Display display;
  display.mutable_quilt()->set_preset("portrait");
  const auto spec = displayFromProto(display);
  if (!spec.ok()) throw std::runtime_error(std::string(spec.status().message()));
  const StageReport stages = measureStages(device, retimed, *spec, EncodingSpec{}, round_count);
  return {{"moving_share", share},
          {"first_time_ms", medianOf(first_ms)},
          {"next_time_ms", medianOf(next_ms)},
          {"sweep_build_ms", stages.sweep_source_ms.value_or(0)},
          {"sweep_ms", stages.sweep_ms.value_or(0)},
          {"walk_build_ms", stages.upload_ms + stages.build_ms},
          {"walk_ms", stages.trace_ms}};
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const SizePx size_px{1920 / arguments.miniature, 1080 / arguments.miniature};
  const FramePtr still = makeSyntheticFrame({.size_px = size_px, .layer_count = kLayers});
  Json json{
      {"device", device.info().name},
      {"date", today()},
      {"source", {{"width_px", size_px.width}, {"height_px", size_px.height}, {"layers", kLayers}}},
      {"shares", Json::array()}};
  for (const double share : {0.0, 0.1, 1.0}) {
    json["shares"].push_back(measureShare(device, *still, share, arguments.round_count));
    if (!arguments.prints_json) std::cout << json["shares"].back().dump() << std::endl;
  }
  if (arguments.prints_json) std::cout << json.dump(2) << "\n";
}

}  // namespace

FramePtr withMotion(const Frame& still, double share) {
  auto frame = std::make_shared<Frame>(still);
  if (share == 0) return frame;  // as an upload keeps it
  const SizePx size_px = frame->format.sources.front().layers.front().depth.size_px;
  const double half_side = 0.5 * std::sqrt(share);
  std::vector<uint8_t> motion;
  motion.reserve(6 * size_px.area());
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const bool moves = std::abs((x + 0.5) / size_px.width - 0.5) < half_side &&
                         std::abs((y + 0.5) / size_px.height - 0.5) < half_side;
      for (const float speed_mps : kSpeed_mps) {
        const uint16_t half = moves ? glm::packHalf1x16(speed_mps) : uint16_t{0};
        motion.push_back(uint8_t(half));
        motion.push_back(uint8_t(half >> 8));
      }
    }
  }
  const auto plane = std::make_shared<const std::vector<uint8_t>>(std::move(motion));
  for (LayerPlanes& layer : frame->sources.front()) layer.motion = plane;
  return frame;
}

void addRetimeCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "retime", "Time for frames between frames, of which a share moves, beside build and trace");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object at the end");
  command.add("--rounds", arguments->round_count, "Of each stage, for the median").between(1, 1000);
  command
      .add("--miniature", arguments->miniature,
           "A frame so many times smaller on a side: tries the program out")
      .between(1, 8);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
