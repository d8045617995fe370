// SPDX-License-Identifier: Apache-2.0
#include "bench/load_list.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/str_cat.h"
#include "bench/bench_frames.h"
#include "commands/manifest_frame.h"

namespace viewloom::bench {
namespace {

constexpr SizePx kSource_px{1920, 1080};
constexpr uint32_t kNoiseSeed = 5;

// px of the source between the nearest surface and the sky in the outermost view.
struct Span {
  const char* name;
  double px;
};
constexpr Span kNormal{"normal", 18};
constexpr Span kWide{"wide", 55};
constexpr Span kExtreme{"extreme", 190};

struct Scene {
  const char* name;
  FramePtr (*make)(SizePx size_px, uint32_t layer_count);
};
constexpr Scene kClutter{"clutter", clutterFrame};
constexpr Scene kSmooth{"smooth", smoothFrame};
constexpr Scene kThin{"thin", thinFrame};

ViewsOf quilt(const char* preset, const Span& span) {
  return [=](const SourceView& source) { return quiltOfSpan(source, preset, span.px); };
}

NamedLoad loadOf(const Scene& scene, uint32_t layer_count, const std::string& views_name,
                 const ViewsOf& views) {
  const std::string name = strCat(scene.name, " x", layer_count, ", ", views_name);
  return {name, [=](const LoadMaker& maker) {
            return maker.make(name, scene.make(kSource_px, layer_count), views);
          }};
}

NamedLoad quiltLoad(const Scene& scene, uint32_t layer_count, const char* preset,
                    const Span& span) {
  return loadOf(scene, layer_count, strCat(preset, " quilt, ", span.name), quilt(preset, span));
}

// Noise of this many px of disparity in the outermost view.
NamedLoad noisyLoad(double noise_px) {
  const std::string name =
      strCat("clutter x2, noise ", noise_px, " px, portrait quilt, ", kNormal.name);
  return {name, [=](const LoadMaker& maker) {
            const FramePtr clean = clutterFrame(kSource_px, 2);
            const double inv_z_per_px =
                maker.make(name, clean, quilt("portrait", kNormal)).source.inv_z_max / kNormal.px;
            return maker.make(name, withNoise(*clean, noise_px * inv_z_per_px, kNoiseSeed),
                              quilt("portrait", kNormal));
          }};
}

NamedLoad sharedAreaLoad(uint32_t view_count) {
  return loadOf(
      kClutter, 2, strCat(view_count, " views of one area, ", kNormal.name),
      [=](const SourceView& source) { return viewsOfSharedArea(source, view_count, kNormal.px); });
}

}  // namespace

std::vector<NamedLoad> quickLoads() {
  std::vector<NamedLoad> loads;
  for (const Span& span : {kNormal, kWide, kExtreme}) {
    loads.push_back(quiltLoad(kClutter, 2, "portrait", span));
  }
  for (const uint32_t layer_count : {1u, 4u}) {
    loads.push_back(quiltLoad(kClutter, layer_count, "portrait", kNormal));
  }
  for (const Scene& scene : {kSmooth, kThin}) {
    loads.push_back(quiltLoad(scene, 2, "portrait", kNormal));
  }
  for (const double noise_px : {0.1, 0.4}) loads.push_back(noisyLoad(noise_px));
  loads.push_back(quiltLoad(kClutter, 2, "16_gen3_l", kNormal));
  loads.push_back(
      loadOf(kClutter, 2, strCat("8x8 parallax, ", kNormal.name),
             [](const SourceView& source) { return gridOfSpan(source, 8, kNormal.px); }));
  loads.push_back(
      loadOf(kClutter, 2, strCat("stepping camera, ", kNormal.name),
             [](const SourceView& source) { return steppingCamera(source, kNormal.px); }));
  for (const uint32_t view_count : {8u, 96u}) loads.push_back(sharedAreaLoad(view_count));
  return loads;
}

std::vector<NamedLoad> fullLoads() {
  std::vector<NamedLoad> loads = quickLoads();
  for (const Scene& scene : {kClutter, kSmooth, kThin}) {
    for (const uint32_t layer_count : {1u, 2u, 4u}) {
      for (const char* preset : {"portrait", "16_gen3_l", "32_gen3_l"}) {
        for (const Span& span : {kNormal, kWide, kExtreme}) {
          NamedLoad load = quiltLoad(scene, layer_count, preset, span);
          const auto is_same = [&](const NamedLoad& other) { return other.name == load.name; };
          if (std::none_of(loads.begin(), loads.end(), is_same)) loads.push_back(std::move(load));
        }
      }
    }
  }
  return loads;
}

std::vector<NamedLoad> buildLoads() {
  std::vector<NamedLoad> loads;
  for (const Scene& scene : {kClutter, kSmooth, kThin}) {
    for (const uint32_t layer_count : {1u, 2u, 4u}) {
      loads.push_back(quiltLoad(scene, layer_count, "portrait", kNormal));
    }
  }
  for (const double noise_px : {0.1, 0.4}) loads.push_back(noisyLoad(noise_px));
  return loads;
}

NamedLoad manifestLoad(const std::filesystem::path& manifest) {
  const std::string name = strCat(manifest.stem().string(), ", portrait quilt, ", kNormal.name);
  return {name, [=](const LoadMaker& maker) {
            const absl::StatusOr<ManifestFrame> frame = readManifestFrame(manifest);
            if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
            return maker.make(name, frame->frame, quilt("portrait", kNormal));
          }};
}

}  // namespace viewloom::bench
