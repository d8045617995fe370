// SPDX-License-Identifier: Apache-2.0
#include "synthetic/synthetic_frame.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "base/processor_count.h"
#include "base/srgb.h"
#include "synthetic/cast_row.h"
#include "synthetic/portrait_scene.h"
#include "synthetic/surface.h"

namespace viewloom {
namespace {

constexpr double kFovY_rad = 36.0 * std::numbers::pi / 180.0;

// Linear light to sRGB. Steps of 1/8192 stay below one 8-bit step where the curve is steepest
// (12.92).
class SrgbTable {
 public:
  SrgbTable() {
    for (size_t i = 0; i < table_.size(); ++i) {
      const double linear = static_cast<double>(i) / static_cast<double>(table_.size() - 1);
      table_[i] = static_cast<uint8_t>(std::lround(255 * srgbFromLinear(linear)));
    }
  }

  uint8_t encode(float linear) const {
    const float last = static_cast<float>(table_.size() - 1);
    // It is never negative, and lround would be a call per px.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    return table_[static_cast<size_t>(std::clamp(linear, 0.0F, 1.0F) * last + 0.5F)];
  }

 private:
  std::array<uint8_t, 8193> table_{};
};

synthetic::Scene sceneOf(const SyntheticOptions& options) {
  return options.setting == synthetic::Setting::kPortrait
             ? synthetic::makePortraitScene(options.time_s)
             : synthetic::makeScene(options.time_s);
}

class FrameRenderer {
 public:
  FrameRenderer(const SyntheticOptions& options, std::vector<SyntheticLayer>& layers)
      : scene_(sceneOf(options)),
        size_px_(options.size_px),
        camera_(options.camera.value_or(syntheticCamera(options.size_px))),
        has_mirrors_(options.has_mirrors),
        has_motion_(options.has_motion),
        layers_(layers) {
    const glm::dvec3 right = camera_.pose.orientation * glm::dvec3(1.0, 0.0, 0.0);
    step_ = right / camera_.intrinsics.focal_px.x;
  }

  // Takes rows until none is left; several threads may do so at once.
  void renderRows() {
    std::vector<synthetic::HitColumn> columns(size_px_.width);
    for (uint32_t y = next_row_++; y < size_px_.height; y = next_row_++) {
      const synthetic::RowRays rays = rowRays(y);
      synthetic::castRow(scene_, rays, static_cast<uint32_t>(layers_.size()), columns);
      for (size_t layer = 0; layer < layers_.size(); ++layer) writeRow(y, layer, rays, columns);
    }
  }

 private:
  synthetic::RowRays rowRays(uint32_t y) const {
    const Intrinsics& pinhole = camera_.intrinsics;
    const glm::dvec3 first{(0.5 - pinhole.principal_px.x) / pinhole.focal_px.x,
                           (pinhole.principal_px.y - y - 0.5) / pinhole.focal_px.y, -1.0};
    return {camera_.pose.position_m, camera_.pose.orientation * first, step_};
  }

  void writeRow(uint32_t y, size_t layer, const synthetic::RowRays& rays,
                const std::vector<synthetic::HitColumn>& columns) {
    static const SrgbTable srgb;
    const size_t row = size_t{y} * size_px_.width;
    uint8_t* color = &layers_[layer].color[4 * row];
    float* depth_m = &layers_[layer].depth_m[row];
    for (size_t x = 0; x < columns.size(); ++x, color += 4) {
      if (layer >= columns[x].count) {
        depth_m[x] = 0;
        std::fill_n(color, 4, uint8_t{0});
        continue;
      }
      const synthetic::Hit& hit = columns[x].hits[layer];
      const glm::dvec3 direction = rays.direction(x);
      const glm::dvec3 point_m = rays.eye_m + hit.depth_m * direction;
      const auto edge_m = static_cast<float>(0.5 * hit.depth_m / camera_.intrinsics.focal_px.x);
      const synthetic::Gloss gloss =
          has_mirrors_ ? synthetic::glossOf(scene_, hit) : synthetic::Gloss{};
      const glm::vec3 linear =
          gloss.own_share *
          synthetic::surfaceColor(scene_, shadows_, hit, point_m, direction, edge_m);
      depth_m[x] = static_cast<float>(hit.depth_m);
      for (int channel = 0; channel < 3; ++channel) color[channel] = srgb.encode(linear[channel]);
      color[3] = 255;
      if (has_mirrors_ && hit.kind != synthetic::SurfaceKind::kSky) {
        const glm::vec3 normal = synthetic::surfaceNormal(scene_, hit, point_m, direction);
        writeGloss(gloss, normal, row + x, layers_[layer]);
      }
      if (has_motion_) {
        const auto halves = synthetic::halvesOf(synthetic::surfaceMotion(scene_, hit, point_m));
        std::copy_n(halves.data(), 3, &layers_[layer].motion[3 * (row + x)]);
      }
    }
  }

  static void writeGloss(const synthetic::Gloss& gloss, const glm::vec3& normal, size_t px,
                         SyntheticLayer& layer) {
    const auto code = [](float value) { return static_cast<uint8_t>(std::lround(255 * value)); };
    layer.normal[px] = synthetic::octahedron(normal);
    layer.roughness[px] = code(gloss.roughness);
    for (int i = 0; i < 3; ++i) layer.specular[3 * px + size_t(i)] = code(gloss.light[i]);
  }

  const synthetic::Scene scene_;
  const synthetic::SunShadows shadows_{scene_};
  const SizePx size_px_;
  const Camera camera_;
  const bool has_mirrors_;
  const bool has_motion_;
  glm::dvec3 step_{0.0};
  std::vector<SyntheticLayer>& layers_;
  std::atomic<uint32_t> next_row_{0};
};

}  // namespace

Camera syntheticCamera(SizePx size_px) {
  Camera camera;
  camera.intrinsics.focal_px = glm::dvec2(0.5 * size_px.height / std::tan(0.5 * kFovY_rad));
  camera.intrinsics.principal_px = 0.5 * glm::dvec2(size_px.width, size_px.height);
  return camera;
}

void renderSyntheticFrame(const SyntheticOptions& options, std::vector<SyntheticLayer>& layers) {
  VIEWLOOM_CHECK(options.layer_count >= 1 && options.layer_count <= synthetic::kMaxLayers);
  layers.resize(options.layer_count);
  for (SyntheticLayer& layer : layers) {
    layer.color.resize(4 * options.size_px.area());
    layer.depth_m.resize(options.size_px.area());
    // Mirrors nothing and stands, whatever a frame before had there.
    const size_t mirrored_px = options.has_mirrors ? options.size_px.area() : 0;
    layer.normal.assign(mirrored_px, 0);
    layer.roughness.assign(mirrored_px, 0);
    layer.specular.assign(3 * mirrored_px, 0);
    layer.motion.assign(options.has_motion ? 3 * options.size_px.area() : 0, 0);
  }
  FrameRenderer renderer(options, layers);
  const uint32_t thread_count = options.thread_count == 0 ? processorCount() : options.thread_count;
  std::vector<std::jthread> helpers;
  for (uint32_t i = 1; i < thread_count; ++i) helpers.emplace_back([&] { renderer.renderRows(); });
  renderer.renderRows();
}

std::vector<SyntheticLayer> renderSyntheticFrame(const SyntheticOptions& options) {
  std::vector<SyntheticLayer> layers;
  renderSyntheticFrame(options, layers);
  return layers;
}

}  // namespace viewloom
