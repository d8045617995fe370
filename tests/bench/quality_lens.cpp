// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_lens.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "bench/lens_scene.h"
#include "scoring/image_score.h"
#include "shared/lens_abi.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

DisplaySpec displayOf(const LensScoring& scoring, const LensWay* way) {
  const Camera view = lensCamera(scoring.view_width_px, scoring.aside_m);
  const CamerasSpec camera{.cameras = {{view.pose, view.intrinsics}},
                           .tile_size_px = lensPictureSize(scoring.view_width_px),
                           .columns = 1};
  DisplaySpec spec{.kind = camera};
  if (way != nullptr) {
    spec.lens = LensSpec{.aperture_radius_m = scoring.radius_m,
                         .focus_distance_m = kLensFocus_m,
                         .walked_count = way->walked_count,
                         .gathered_count = way->gathered_count,
                         .is_exact = way->is_exact};
  }
  auto completed = completeDisplaySpec(spec);
  if (!completed.ok()) throw std::runtime_error(std::string(completed.status().message()));
  return *std::move(completed);
}

struct Rendered {
  RenderedAtlas atlas;
  double trace_ms = 0;
};

// Everything around the trace is left out but what bands of it take to be submitted.
Rendered render(OfflineRenderer& renderer, const DisplaySpec& spec, bool is_linear,
                uint32_t round_count) {
  std::vector<double> times_ms;
  std::optional<RenderedAtlas> rendered;
  for (uint32_t round = 0; round <= round_count; ++round) {
    const auto begun = std::chrono::steady_clock::now();
    auto atlas = renderer.render(spec, {.linear = is_linear}, [](uint32_t, uint32_t) {});
    const auto ended = std::chrono::steady_clock::now();
    if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));
    rendered = *std::move(atlas);
    // The first compiles.
    if (round > 0) {
      times_ms.push_back(std::chrono::duration<double, std::milli>(ended - begun).count());
    }
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + times_ms.size() / 2, times_ms.end());
  return {*std::move(rendered), times_ms.empty() ? 0 : times_ms[times_ms.size() / 2]};
}

// Of what lies further in than blur reaches: beyond the image nothing is known.
void score(const RenderedAtlas& atlas, const std::vector<float>& truth, LensScore& result) {
  const SizePx size_px = atlas.layout->size_px;
  const uint32_t margin_px = size_px.width / 20;
  double squares = 0;
  double errors = 0;
  double lights = 0;
  size_t count = 0;
  for (uint32_t y = margin_px; y + margin_px < size_px.height; ++y) {
    for (uint32_t x = margin_px; x + margin_px < size_px.width; ++x) {
      const size_t px = size_t{y} * size_px.width + x;
      for (size_t c = 0; c < 3; ++c) {
        const double got = atlas.linear[4 * px + c];
        const double light = truth[3 * px + c];
        squares += std::pow(got - srgbFromLinear(light), 2);
        errors += linearFromSrgb(got) - light;
        lights += light;
        ++count;
      }
    }
  }
  result.psnr_db = -10 * std::log10(squares / double(count));
  result.mean_error = errors / double(count);
  result.level_db = 10 * std::log10((lights + errors) / lights);
}

std::vector<float> truthOf(const truth::Instant& instant, const LensScoring& scoring) {
  return trueLensPicture(instant, lensCamera(scoring.view_width_px, scoring.aside_m),
                         lensPictureSize(scoring.view_width_px), scoring.radius_m,
                         scoring.true_ray_count);
}

// The error's steps between px beside each other, at the sides of the blocks that the second stage
// works in (shared/lens_abi.h), beside those of all other px.
double seamsOf(const RenderedAtlas& atlas, const std::vector<float>& truth) {
  const SizePx size_px = atlas.layout->size_px;
  const auto errorOf = [&](uint32_t x, uint32_t y) {
    const size_t px = size_t{y} * size_px.width + x;
    return atlas.linear[4 * px + 1] - srgbFromLinear(truth[3 * px + 1]);
  };
  double steps[2] = {};
  size_t counts[2] = {};
  const auto add = [&](uint32_t before, double step) {
    const bool is_seam = (before + 1) % abi::kMetBlockSide_px == 0;
    steps[is_seam] += std::abs(step);
    ++counts[is_seam];
  };
  for (uint32_t y = 0; y + 1 < size_px.height; ++y) {
    for (uint32_t x = 0; x + 1 < size_px.width; ++x) {
      add(x, errorOf(x + 1, y) - errorOf(x, y));
      add(y, errorOf(x, y + 1) - errorOf(x, y));
    }
  }
  return steps[1] / double(counts[1]) / (steps[0] / double(counts[0]));
}

FramePtr roomFrame(const truth::Instant& instant, uint32_t width_px, uint32_t layer_count) {
  const truth::Picture picture = truth::takePicture(
      instant, lensCamera(width_px), {.size_px = lensPictureSize(width_px), .layer_count = 3});
  return truth::frameOf(picture, layer_count);
}

}  // namespace

std::vector<LensScore> lensScores(const Device& device, const LensScoring& scoring,
                                  const std::vector<LensWay>& ways) {
  const truth::Instant instant(truth::clutteredRoom(), 0);
  const std::vector<float> truth = truthOf(instant, scoring);
  OfflineRenderer renderer(device, scoring.place);
  std::vector<LensScore> scores;
  uint32_t built_layers = 0;
  double pinhole_ms = 0;
  for (const LensWay& way : ways) {
    if (way.layer_count != built_layers) {
      built_layers = way.layer_count;
      renderer.build(*roomFrame(instant, scoring.source_width_px, built_layers));
      const DisplaySpec sharp = displayOf(scoring, nullptr);
      pinhole_ms = render(renderer, sharp, false, scoring.round_count).trace_ms;
    }
    const DisplaySpec spec = displayOf(scoring, &way);
    LensScore result{.way = way};
    const RenderedAtlas atlas = render(renderer, spec, true, 0).atlas;
    score(atlas, truth, result);
    result.seams = seamsOf(atlas, truth);
    result.trace_ms = render(renderer, spec, false, scoring.round_count).trace_ms;
    result.pinholes = result.trace_ms / pinhole_ms;
    scores.push_back(result);
  }
  return scores;
}

Json qualityOfLens(const Device& device) {
  std::vector<LensWay> ways;
  for (const uint32_t layers : {1, 2, 3}) {
    for (const uint32_t walked : {1, 2, 4, 8, 16, 40}) {
      ways.push_back({.layer_count = layers, .walked_count = walked});
    }
    for (const uint32_t walked : {2, 4, 8, 16}) {
      ways.push_back({.layer_count = layers, .walked_count = walked, .gathered_count = 4 * walked});
    }
    ways.push_back(
        {.layer_count = layers, .walked_count = 8, .gathered_count = 32, .is_exact = true});
  }
  Json rows = Json::array();
  const auto add = [&](GatheringPlace place, const std::vector<LensWay>& added) {
    for (const LensScore& score : lensScores(device, {.place = place}, added)) {
      rows.push_back({{"layers", score.way.layer_count},
                      {"walked", score.way.walked_count},
                      {"gathered", score.way.gathered_count},
                      {"mode", score.way.is_exact ? "exact" : "fast"},
                      {"place", place == GatheringPlace::kHost ? "host" : "device"},
                      {"psnr_db", score.psnr_db},
                      {"mean_error", score.mean_error},
                      {"level_db", score.level_db},
                      {"seams", score.seams},
                      {"trace_ms", score.trace_ms},
                      {"pinhole_traces", score.pinholes}});
    }
  };
  add(GatheringPlace::kHost, ways);
  std::erase_if(ways, [](const LensWay& way) { return way.gathered_count == 0 || way.is_exact; });
  add(GatheringPlace::kDevice, ways);
  return rows;
}

}  // namespace viewloom::bench
