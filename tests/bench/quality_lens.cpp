// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_lens.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "base/worker_pool.h"
#include "commands/offline_renderer.h"
#include "scoring/image_score.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRadius_m = 0.02;
constexpr double kFocus_m = 2.4;
constexpr double kSlope = 0.5;  // of the widest ray of the view, to the side

Camera cameraOf(uint32_t width_px) {
  const double height_px = width_px * 9.0 / 16;
  const double focal_px = width_px / (2 * kSlope);
  return {.pose = {},
          .intrinsics = {.focal_px = {focal_px, focal_px},
                         .principal_px = {width_px / 2.0, height_px / 2}}};
}

SizePx sizeOf(uint32_t width_px) {
  return {width_px, width_px * 9 / 16};
}

// Halton's sequence, which has nothing to do with what is scored.
double radicalInverse(uint32_t index, uint32_t base) {
  double inverse = 0;
  double digit = 1;
  for (; index > 0; index /= base) {
    digit /= base;
    inverse += digit * (index % base);
  }
  return inverse;
}

glm::dvec2 onDisc(double share, double turn) {
  const double angle_rad = 2 * std::numbers::pi * turn;
  return std::sqrt(share) * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
}

// The light of a px: of exact rays over its area and the lens, each of which goes to where the
// middle's ray through the same place of the px is in focus.
glm::dvec3 trueLight(const truth::Instant& instant, const Camera& camera, glm::dvec2 px,
                     uint32_t ray_count) {
  glm::dvec3 light(0.0);
  const Intrinsics& in = camera.intrinsics;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const glm::dvec2 at = px + glm::dvec2(radicalInverse(i, 5), radicalInverse(i, 7));
    const glm::dvec2 eye_m = kRadius_m * onDisc(radicalInverse(i, 2), radicalInverse(i, 3));
    const glm::dvec2 slope = (at - in.principal_px) / in.focal_px;
    Camera moved = camera;
    moved.pose.position_m += glm::dvec3(eye_m, 0);
    const glm::dvec2 from_eye = slope - glm::dvec2(eye_m.x, -eye_m.y) / kFocus_m;
    const truth::Ray ray = truth::rayThrough(moved, from_eye * in.focal_px + in.principal_px);
    const truth::HitColumn column = instant.peel(ray, 1);
    if (column.count > 0) light += glm::dvec3(instant.color(ray, column.hits[0]));
  }
  return light / double(ray_count);
}

// Linear light, float[height][width][3].
std::vector<float> truePicture(const truth::Instant& instant, const LensScoring& scoring) {
  const SizePx size_px = sizeOf(scoring.view_width_px);
  const Camera camera = cameraOf(scoring.view_width_px);
  std::vector<float> light(3 * size_px.area());
  WorkerPool workers;
  workers.forEach(size_px.height, [&](uint32_t y, uint32_t) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const glm::dvec3 of_px = trueLight(instant, camera, {x, y}, scoring.true_ray_count);
      for (int c = 0; c < 3; ++c) light[3 * (size_t{y} * size_px.width + x) + c] = float(of_px[c]);
    }
  });
  return light;
}

DisplaySpec displayOf(const LensScoring& scoring, const LensWay* way) {
  const CamerasSpec camera{.cameras = {{Pose{}, cameraOf(scoring.view_width_px).intrinsics}},
                           .tile_size_px = sizeOf(scoring.view_width_px),
                           .columns = 1};
  DisplaySpec spec{.kind = camera};
  if (way != nullptr) {
    spec.lens = LensSpec{.aperture_radius_m = kRadius_m,
                         .focus_distance_m = kFocus_m,
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
  size_t count = 0;
  for (uint32_t y = margin_px; y + margin_px < size_px.height; ++y) {
    for (uint32_t x = margin_px; x + margin_px < size_px.width; ++x) {
      const size_t px = size_t{y} * size_px.width + x;
      for (size_t c = 0; c < 3; ++c) {
        const double got = atlas.linear[4 * px + c];
        const double light = truth[3 * px + c];
        squares += std::pow(got - srgbFromLinear(light), 2);
        errors += linearFromSrgb(got) - light;
        ++count;
      }
    }
  }
  result.psnr_db = -10 * std::log10(squares / double(count));
  result.mean_error = errors / double(count);
}

}  // namespace

std::vector<LensScore> lensScores(const Device& device, const LensScoring& scoring,
                                  const std::vector<LensWay>& ways) {
  const truth::Instant instant(truth::clutteredRoom(), 0);
  const std::vector<float> truth = truePicture(instant, scoring);
  const truth::Picture picture =
      truth::takePicture(instant, cameraOf(scoring.source_width_px),
                         {.size_px = sizeOf(scoring.source_width_px), .layer_count = 3});
  OfflineRenderer renderer(device);
  std::vector<LensScore> scores;
  uint32_t built_layers = 0;
  double pinhole_ms = 0;
  for (const LensWay& way : ways) {
    if (way.layer_count != built_layers) {
      built_layers = way.layer_count;
      renderer.build(*truth::frameOf(picture, built_layers));
      const DisplaySpec sharp = displayOf(scoring, nullptr);
      pinhole_ms = render(renderer, sharp, false, scoring.round_count).trace_ms;
    }
    const DisplaySpec spec = displayOf(scoring, &way);
    LensScore result{.way = way};
    score(render(renderer, spec, true, 0).atlas, truth, result);
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
  for (const LensScore& score : lensScores(device, {}, ways)) {
    rows.push_back({{"layers", score.way.layer_count},
                    {"walked", score.way.walked_count},
                    {"gathered", score.way.gathered_count},
                    {"mode", score.way.is_exact ? "exact" : "fast"},
                    {"psnr_db", score.psnr_db},
                    {"mean_error", score.mean_error},
                    {"trace_ms", score.trace_ms},
                    {"pinhole_traces", score.pinholes}});
  }
  return rows;
}

}  // namespace viewloom::bench
