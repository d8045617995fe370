// SPDX-License-Identifier: Apache-2.0
#include "bench/load_list.h"

#include <algorithm>
#include <utility>

#include "base/str_cat.h"
#include "bench/bench_frames.h"
#include "bench/true_views.h"

namespace viewloom::bench {
namespace {

constexpr SizePx kSource_px{1920, 1080};
constexpr SizePx k4K_px{3840, 2160};
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
  std::vector<uint32_t> (*look)(const Camera& view, SizePx view_px, SizePx source_px);
};
constexpr Scene kClutter{"clutter", clutterFrame, trueClutter};
constexpr Scene kSmooth{"smooth", smoothFrame, trueSmooth};
constexpr Scene kThin{"thin", thinFrame, trueThin};

TrueView trueView(const Scene& scene, SizePx source_px) {
  return [look = scene.look, source_px](const Camera& view, SizePx view_px) {
    return look(view, view_px, source_px);
  };
}

ViewsOf quilt(const char* preset, const Span& span) {
  return [=](const SourceView& source) { return quiltOfSpan(source, preset, span.px); };
}

NamedLoad loadOf(const Scene& scene, uint32_t layer_count, const std::string& views_name,
                 const ViewsOf& views, SizePx source_px = kSource_px) {
  const std::string name = strCat(scene.name, " x", layer_count, ", ", views_name);
  return {name, [=](const LoadMaker& maker) {
            const SizePx size_px = maker.sceneSize(source_px);
            BenchLoad load = maker.make(name, scene.make(size_px, layer_count), views);
            load.true_view = trueView(scene, size_px);
            return load;
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
            const SizePx size_px = maker.sceneSize(kSource_px);
            const FramePtr clean = clutterFrame(size_px, 2);
            const double inv_z_per_px =
                maker.make(name, clean, quilt("portrait", kNormal)).source.inv_z_max / kNormal.px;
            BenchLoad load =
                maker.make(name, withNoise(*clean, noise_px * inv_z_per_px, kNoiseSeed),
                           quilt("portrait", kNormal));
            load.true_view = trueView(kClutter, size_px);
            return load;
          }};
}

NamedLoad parallaxLoad(const Span& span) {
  constexpr uint32_t kSide = 8;
  return loadOf(kClutter, 2, strCat("8x8 parallax, ", span.name),
                [=](const SourceView& source) { return gridOfSpan(source, kSide, span.px); });
}

// Views that stand nowhere in particular.
NamedLoad posedLoad(const char* name, AtlasLayout (*views)(const SourceView&, double span_px)) {
  return loadOf(kClutter, 2, strCat(name, ", ", kNormal.name),
                [=](const SourceView& source) { return views(source, kNormal.px); });
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
  for (const char* preset : {"16_gen3_l", "32_gen3_l"}) {
    loads.push_back(quiltLoad(kClutter, 2, preset, kNormal));
  }
  for (const Span& span : {kNormal, kWide, kExtreme}) loads.push_back(parallaxLoad(span));
  loads.push_back(posedLoad("stepping camera", steppingCamera));
  loads.push_back(posedLoad("one rotated view", rotatedView));
  for (const uint32_t view_count : {8u, 96u}) loads.push_back(sharedAreaLoad(view_count));
  return loads;
}

std::vector<NamedLoad> fullLoads() {
  std::vector<NamedLoad> loads = quickLoads();
  loads.push_back(loadOf(kClutter, 4, strCat("4K, 32_gen3_l quilt, ", kNormal.name),
                         quilt("32_gen3_l", kNormal), k4K_px));
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

}  // namespace viewloom::bench
