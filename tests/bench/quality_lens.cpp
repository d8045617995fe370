// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_lens.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "bench/lens_scene.h"
#include "offline/median.h"
#include "scoring/image_score.h"
#include "scoring/psnr.h"
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

RenderedAtlas render(OfflineRenderer& renderer, const DisplaySpec& spec, bool is_linear) {
  auto atlas = renderer.render(spec, {.linear = is_linear}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));
  return *std::move(atlas);
}

// Everything around the trace is left out but what bands of it take to be submitted.
double renderMs(OfflineRenderer& renderer, const DisplaySpec& spec) {
  const auto begun = std::chrono::steady_clock::now();
  render(renderer, spec, false);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
      .count();
}

// The view through the lens and without one, in turn.
void measure(OfflineRenderer& renderer, const LensScoring& scoring, LensScore& result) {
  if (scoring.round_count == 0) return;
  const DisplaySpec sharp = displayOf(scoring, nullptr);
  const DisplaySpec blurred = displayOf(scoring, &result.way);
  std::vector<double> sharp_ms, blurred_ms;
  for (uint32_t round = 0; round <= scoring.round_count; ++round) {
    sharp_ms.push_back(renderMs(renderer, sharp));
    blurred_ms.push_back(renderMs(renderer, blurred));
    // The first compile.
    if (round == 0) {
      sharp_ms.clear();
      blurred_ms.clear();
    }
  }
  result.trace_ms = medianOf(blurred_ms);
  result.pinhole_ms = medianOf(sharp_ms);
}

struct TrueView {
  std::vector<float> light;          // as trueLensPicture() gives it
  std::vector<float> hidden_shares;  // as hiddenShares()
};

TrueView trueViewOf(const truth::Instant& instant, const LensScoring& scoring) {
  if (scoring.true_ray_count == 0) return {};
  // A px is told from others by its shares of so many.
  constexpr uint32_t kRaysToHidden = 16;
  const Camera view = lensCamera(scoring.view_width_px, scoring.aside_m);
  const SizePx size_px = lensPictureSize(scoring.view_width_px);
  return {
      .light = trueLensPicture(instant, view, size_px, scoring.radius_m, scoring.true_ray_count),
      .hidden_shares = hiddenShares(instant, view, size_px, scoring.radius_m, kRaysToHidden)};
}

// Share of a px's rays.
constexpr float kHiddenShare = 0.1F;

// Scores px further in than blur reaches: beyond the image nothing is known.
void score(const RenderedAtlas& atlas, const TrueView& truth, LensScore& result) {
  const SizePx size_px = atlas.layout->size_px;
  const uint32_t margin_px = size_px.width / 20;
  Psnr psnr;
  Psnr hidden_psnr;
  double errors = 0;
  double lights = 0;
  size_t count = 0;
  size_t hidden_count = 0;
  for (uint32_t y = margin_px; y + margin_px < size_px.height; ++y) {
    for (uint32_t x = margin_px; x + margin_px < size_px.width; ++x) {
      const size_t px = size_t{y} * size_px.width + x;
      const bool is_hidden = truth.hidden_shares[px] >= kHiddenShare;
      for (size_t c = 0; c < 3; ++c) {
        const double got = atlas.linear[4 * px + c];
        const double light = truth.light[3 * px + c];
        const double error = got - srgbFromLinear(light);
        psnr.add(error);
        if (is_hidden) hidden_psnr.add(error);
        hidden_count += is_hidden;
        errors += linearFromSrgb(got) - light;
        lights += light;
        ++count;
      }
    }
  }
  result.psnr_db = psnr.db();
  result.hidden_psnr_db = hidden_psnr.db();
  result.hidden_px_share = double(hidden_count) / double(count);
  result.mean_error = errors / double(count);
  result.level_db = 10 * std::log10((lights + errors) / lights);
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

std::vector<LensScore> lensScores(OfflineRenderer& renderer, const LensScoring& scoring,
                                  const std::vector<LensWay>& ways) {
  const truth::Instant instant(truth::clutteredRoom(), 0);
  const TrueView truth = trueViewOf(instant, scoring);
  std::vector<LensScore> scores;
  uint32_t built_layers = 0;
  for (const LensWay& way : ways) {
    if (way.layer_count != built_layers) {
      built_layers = way.layer_count;
      renderer.build(*roomFrame(instant, scoring.source_width_px, built_layers));
    }
    LensScore result{.way = way};
    if (!truth.light.empty()) {
      const RenderedAtlas atlas = render(renderer, displayOf(scoring, &way), true);
      score(atlas, truth, result);
      result.seams = seamsOf(atlas, truth.light);
    }
    measure(renderer, scoring, result);
    scores.push_back(result);
  }
  return scores;
}

namespace {

Json jsonOf(const LensScoring& scoring, const LensScore& score, const char* place) {
  Json row = {{"source_width_px", scoring.source_width_px},
              {"view_width_px", scoring.view_width_px},
              {"layers", score.way.layer_count},
              {"walked", score.way.walked_count},
              {"gathered", score.way.gathered_count},
              {"mode", score.way.is_exact ? "exact" : "fast"},
              {"place", place}};
  if (scoring.true_ray_count > 0) {
    row.update({{"psnr_db", score.psnr_db},
                {"hidden_psnr_db", score.hidden_psnr_db},
                {"hidden_px_share", score.hidden_px_share},
                {"mean_error", score.mean_error},
                {"level_db", score.level_db},
                {"seams", score.seams}});
  }
  row["trace_ms"] = score.trace_ms;
  row["pinhole_traces"] = score.trace_ms / score.pinhole_ms;
  return row;
}

}  // namespace

Json qualityOfLens(const Device& device) {
  constexpr uint32_t kLayerCounts[] = {1, 2, 3};
  std::vector<LensWay> ways, gathered, balanced;
  for (const uint32_t layers : kLayerCounts) {
    for (const uint32_t walked : {1, 2, 4, 8, 16, 40}) {
      ways.push_back({.layer_count = layers, .walked_count = walked});
    }
    for (const uint32_t walked : {2, 4, 8, 16}) {
      const LensWay way{
          .layer_count = layers, .walked_count = walked, .gathered_count = 4 * walked};
      ways.push_back(way);
      gathered.push_back(way);
      if (walked == 8) balanced.push_back(way);
    }
    ways.push_back(
        {.layer_count = layers, .walked_count = 8, .gathered_count = 32, .is_exact = true});
  }
  Json rows = Json::array();
  OfflineRenderer on_host(device, GatheringPlace::kHost);
  const auto add = [&](const LensScoring& scoring, const std::vector<LensWay>& added) {
    for (const LensScore& score : lensScores(on_host, scoring, added)) {
      rows.push_back(jsonOf(scoring, score, "host"));
    }
  };
  add({}, ways);
  OfflineRenderer on_device(device, GatheringPlace::kDevice);
  for (const LensScore& score : lensScores(on_device, {}, gathered)) {
    rows.push_back(jsonOf({}, score, "device"));
  }
  // Cost of views as large as those of displays.
  add({.view_width_px = 640, .true_ray_count = 0}, balanced);
  add({.view_width_px = 960, .true_ray_count = 0}, balanced);
  add({.source_width_px = 1920, .view_width_px = 960, .true_ray_count = 0}, balanced);
  return rows;
}

}  // namespace viewloom::bench
