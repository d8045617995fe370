// SPDX-License-Identifier: Apache-2.0
// Whether the engines of this server can work on this machine.
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "base/str_cat.h"
#include "commands/doctor_checks.h"
#include "gpu/device_error.h"
#include "walk/offline_renderer.h"

namespace viewloom {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
// A Looking Glass Portrait from a 1080p source, with two slots and everything else of a process.
constexpr double kComfortableMemory_gib = 2;

std::string describe(const DeviceInfo& info) {
  return absl::StrFormat("%u: %s, driver %s, %.1f GiB, buffers up to %.2f GiB", info.index,
                         info.name, info.driver,
                         static_cast<double>(info.limits.memory_bytes) / kGib,
                         static_cast<double>(info.limits.allocation_bytes_max) / kGib);
}

Finding judge(const DeviceInfo& info) {
  if (!info.missing_features.empty()) {
    return {Verdict::kAdvice, "device",
            strCat(describe(info), "; it lacks ", absl::StrJoin(info.missing_features, ", ")),
            "update its driver, or leave it to others: viewloomd takes another device"};
  }
  return {Verdict::kFine, "device", describe(info), ""};
}

Finding judgeChosen(const DeviceInfo& info) {
  if (info.is_software) {
    return {Verdict::kAdvice, "device", strCat("would use ", info.name, ", which runs on the CPU"),
            "for speed install the driver of a GPU, or name it with --device"};
  }
  if (static_cast<double>(info.limits.memory_bytes) < kComfortableMemory_gib * kGib) {
    return {Verdict::kAdvice, "device",
            strCat("would use ", info.name, ", which has little memory"),
            "publish smaller frames, or name another device with --device"};
  }
  return {Verdict::kFine, "device", strCat("would use ", info.name), ""};
}

// A grey wall at 2 m with a brighter square 1 m before it.
FramePtr smallScene() {
  constexpr SizePx kSize_px = {64, 48};
  constexpr float kWall_m = 2, kSquare_m = 1;
  SourceFormat source;
  source.camera.intrinsics = {.focal_px = glm::dvec2(kSize_px.width), .principal_px = {32, 24}};
  source.layers.push_back(
      {.color = {.kind = PlaneKind::kColor, .size_px = kSize_px},
       .depth = {
           .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = kSize_px}});
  std::vector<uint8_t> color;
  std::vector<float> depth_m;
  for (uint32_t y = 0; y < kSize_px.height; ++y) {
    for (uint32_t x = 0; x < kSize_px.width; ++x) {
      const bool is_square = x / 16 == 1 && y / 16 == 1;
      const uint8_t grey = is_square ? 200 : 100;
      color.insert(color.end(), {grey, grey, grey, 255});
      depth_m.push_back(is_square ? kSquare_m : kWall_m);
    }
  }
  std::vector<uint8_t> depth(depth_m.size() * sizeof(float));
  std::memcpy(depth.data(), depth_m.data(), depth.size());
  const auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  frame->format.sources.push_back(std::move(source));
  frame->sources.push_back({{.color = std::make_shared<std::vector<uint8_t>>(std::move(color)),
                             .depth = std::make_shared<std::vector<uint8_t>>(std::move(depth))}});
  return frame;
}

// Which devices there are, which lack what, which one would be taken, and its limits.
std::vector<Finding> checkDevices(const Config& config) {
  const std::vector<DeviceInfo> devices = Device::listDevices();
  std::vector<Finding> findings;
  findings.reserve(devices.size() + 1);
  for (const DeviceInfo& info : devices) findings.push_back(judge(info));
  if (devices.empty()) {
    return {{Verdict::kProblem, "device", "there is no Vulkan device",
             "install mesa-vulkan-drivers, which has one that runs on the CPU"}};
  }
  try {
    const Device chosen({.select = config.device, .validation = config.validation});
    findings.push_back(judgeChosen(chosen.info()));
  } catch (const std::exception& error) {
    findings.push_back({Verdict::kProblem, "device", deviceErrorText(error),
                        "name a device of the list above with --device, or none"});
  }
  return findings;
}

// Builds and traces a small scene on the device that would be taken.
std::vector<Finding> checkTrace(const Config& config) try {
  const FramePtr frame = smallScene();
  const auto spec =
      completeDisplaySpec({.kind = QuiltSpec{.columns = 2, .rows = 2, .size_px = {128, 96}}});
  if (!spec.ok()) throw std::runtime_error(std::string(spec.status().message()));
  const Device device({.select = config.device});
  OfflineRenderer renderer(device);
  renderer.build(*frame);
  const auto atlas = renderer.render(*spec, {}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));
  const Coverage& coverage = atlas->coverage;
  if (coverage.rayCount() != uint64_t{128} * 96 || coverage.hit == 0) {
    throw std::runtime_error("rays of a small scene got lost");
  }
  return {{Verdict::kFine, "picture", "a small scene was rendered", ""}};
} catch (const std::exception& error) {
  return {{Verdict::kProblem, "picture",
           strCat("a small scene could not be rendered: ", deviceErrorText(error)),
           "update the device's driver, or name another device with --device"}};
}

}  // namespace

std::vector<Finding> checkEngines(const Config& config) {
  std::vector<Finding> findings = checkDevices(config);
  if (hasProblem(findings)) return findings;
  for (Finding& finding : checkTrace(config)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace viewloom
