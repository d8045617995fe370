// SPDX-License-Identifier: Apache-2.0
#include "bench/recorded_loads.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "base/str_cat.h"
#include "offline/manifest_frame.h"
#include "scoring/image_score.h"
#include "support/data_sets.h"

namespace viewloom::bench {
namespace {

constexpr double kNormalSpan_px = 18;  // as the other loads'

template <typename T>
T valueOrThrow(absl::StatusOr<T> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

double channelAt(const LayerPlanes& planes, size_t index) {
  if (planes.color_encoding == PlaneEncoding::kRgba8) return (*planes.color)[index] / 255.0;
  uint16_t half = 0;
  std::memcpy(&half, planes.color->data() + 2 * index, sizeof half);
  return double{glm::unpackHalf1x16(half)};
}

SharedBytes plainColor(const LayerPlanes& planes, const PlaneFormat& format, double gain) {
  auto bytes = std::make_shared<std::vector<uint8_t>>(4 * format.size_px.area());
  for (size_t i = 0; i < bytes->size(); ++i) {
    double value = channelAt(planes, i);
    if (format.transfer == ColorTransfer::kLinear || gain != 1) {
      const bool is_light = format.transfer == ColorTransfer::kLinear;
      value = srgbFromLinear(std::max(gain * (is_light ? value : linearFromSrgb(value)), 0.0));
    }
    (*bytes)[i] = i % 4 == 3 ? 255 : uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  }
  return bytes;
}

FramePtr plainFrame(const Frame& frame) {
  auto plain = std::make_shared<Frame>(frame);
  const double gain = std::exp2(frame.format.exposure_ev);
  plain->format.exposure_ev = 0;
  std::vector<LayerFormat>& layers = plain->format.sources.front().layers;
  for (size_t i = 0; i < layers.size(); ++i) {
    PlaneFormat& color = layers[i].color;
    if (color.size_px != layers.front().depth.size_px) {
      throw std::runtime_error("colour and depth differ in size: no rival takes that");
    }
    LayerPlanes& planes = plain->sources.front()[i];
    planes.color = plainColor(planes, color, gain);
    planes.color_encoding = PlaneEncoding::kRgba8;
    color.encoding = PlaneEncoding::kRgba8;
    color.transfer = ColorTransfer::kSrgb;
    color.primaries = ColorPrimaries::kBt709;
    color.alpha = AlphaMode::kOpaque;
  }
  return plain;
}

NamedLoad portraitLoad(const std::string& what, const std::function<FramePtr()>& read) {
  const std::string name = strCat(what, ", portrait quilt, normal");
  return {name, [=](const LoadMaker& maker) {
            return maker.make(name, plainFrame(*read()), [](const SourceView& source) {
              return quiltOfSpan(source, "portrait", kNormalSpan_px);
            });
          }};
}

}  // namespace

NamedLoad manifestLoad(const std::filesystem::path& manifest) {
  return portraitLoad(manifest.stem().string(),
                      [=] { return valueOrThrow(readManifestFrame(manifest)).frame; });
}

RecordedLoads recordedLoads(const std::filesystem::path& data) {
  struct Recorded {
    const char* name;
    const char* folder;
    std::function<absl::StatusOr<test::DataSet>()> load;
  };
  const Recorded all[] = {{"beachball", "beachball-stereo",
                           [=] {
                             return test::loadBeachBall(data, {"R", "G", "B"});
                           }},
                          {"antinous", "hci-antinous", [=] { return test::loadAntinous(data); }}};
  RecordedLoads found;
  for (const Recorded& set : all) {
    NamedLoad load = portraitLoad(set.name, [read = set.load] {
      return valueOrThrow(loadManifestFrame(frameManifest(valueOrThrow(read())), {})).frame;
    });
    if (std::filesystem::exists(data / set.folder)) {
      found.loads.push_back(std::move(load));
    } else {
      found.skipped.push_back(
          {std::move(load.name), strCat((data / set.folder).string(), " does not exist")});
    }
  }
  return found;
}

}  // namespace viewloom::bench
