// SPDX-License-Identifier: Apache-2.0
#include "deep/tidy_pixel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace viewloom::deep {
namespace {

constexpr float kNearest_m = 1e-9F;  // what is nearer is no surface (proto DepthFormat)
constexpr float kColorMax = 65504;   // the largest binary16
// Slices keep the depth of volumes: within one, 1/Z is off by less than half of this share, about
// what the server's tolerance for steps inside one surface is. Eight are more than there are
// layers.
constexpr double kSliceShare = 1.0 / 16;
constexpr double kSlicesMax = 8;
constexpr double kInfinite_m = std::numeric_limits<double>::infinity();

float finite(float value) {
  return std::isnan(value) ? 0 : std::clamp(value, -kColorMax, kColorMax);
}

}  // namespace

bool PixelTidier::isVolume(const DeepSample& sample) {
  return sample.z_back_m > sample.z_m && sample.alpha < 1 && std::isfinite(sample.z_back_m);
}

PixelTidier::Matter PixelTidier::matterOf(const DeepSample& sample) {
  const glm::dvec3 color(sample.color);
  if (sample.alpha >= 1) return {.opaque_color = color, .opaque_count = 1};
  const double alpha = sample.alpha;
  const double optical_depth = -std::log1p(-alpha);
  return {.optical_depth = optical_depth,
          .emission = alpha > 0 ? color * (optical_depth / alpha) : color};
}

// Light through matter that absorbs and emits: alpha = 1 - exp(-d), and of what is emitted evenly
// along the way alpha / d comes out.
DeepPoint PixelTidier::pointOf(const Matter& matter, double inv_z) {
  if (matter.opaque_count > 0) {
    return {.inv_z = inv_z, .alpha = 1, .color = matter.opaque_color / matter.opaque_count};
  }
  // Differences of sums may end a rounding below nothing.
  const double optical_depth = std::max(matter.optical_depth, 0.0);
  const double alpha = -std::expm1(-optical_depth);
  return {.inv_z = inv_z,
          .alpha = alpha,
          .color = optical_depth > 0 ? matter.emission * (alpha / optical_depth) : matter.emission};
}

std::span<const DeepPoint> PixelTidier::tidy(std::span<const DeepSample> samples) {
  points_.clear();
  take(samples);
  sweep();
  return points_;
}

void PixelTidier::take(std::span<const DeepSample> samples) {
  samples_.clear();
  by_back_.clear();
  for (DeepSample sample : samples) {
    if (!(sample.z_m >= kNearest_m)) {
      ++dropped_count_;
      continue;
    }
    sample.alpha = std::isnan(sample.alpha) ? 0 : std::clamp(sample.alpha, 0.0F, 1.0F);
    for (int i = 0; i < 3; ++i) sample.color[i] = finite(sample.color[i]);
    samples_.push_back(sample);
    if (isVolume(sample)) by_back_.push_back(sample);
  }
  std::stable_sort(samples_.begin(), samples_.end(), [](const DeepSample& a, const DeepSample& b) {
    return a.z_m != b.z_m ? a.z_m < b.z_m : isVolume(a) < isVolume(b);
  });
  std::sort(by_back_.begin(), by_back_.end(),
            [](const DeepSample& a, const DeepSample& b) { return a.z_back_m < b.z_back_m; });
}

// Goes through all fronts and backs by depth; between two of them the same volumes overlap.
void PixelTidier::sweep() {
  Matter per_metre;
  size_t open_count = 0;  // volumes that have begun and not ended
  const auto add_volume_of = [&](const DeepSample& sample, double sign) {
    const Matter matter = matterOf(sample);
    const double share = sign / (double{sample.z_back_m} - double{sample.z_m});
    per_metre.optical_depth += share * matter.optical_depth;
    per_metre.emission += share * matter.emission;
  };
  size_t front = 0;
  size_t back = 0;
  double at_m = 0;
  while (front < samples_.size() || back < by_back_.size()) {
    const double front_m = front < samples_.size() ? samples_[front].z_m : kInfinite_m;
    const double back_m = back < by_back_.size() ? by_back_[back].z_back_m : kInfinite_m;
    const double next_m = std::min(front_m, back_m);
    if (open_count > 0) addVolume(at_m, next_m, per_metre);
    at_m = next_m;
    for (; back < by_back_.size() && by_back_[back].z_back_m == at_m; ++back, --open_count) {
      add_volume_of(by_back_[back], -1);
    }
    if (open_count == 0) per_metre = {};  // what the sums' rounding left
    size_t end = front;
    while (end < samples_.size() && samples_[end].z_m == at_m && !isVolume(samples_[end])) ++end;
    addCoincident(front, end);
    for (front = end; front < samples_.size() && samples_[front].z_m == at_m; ++front) {
      add_volume_of(samples_[front], 1);
      ++open_count;
    }
  }
}

void PixelTidier::addCoincident(size_t begin, size_t end) {
  if (begin == end) return;
  const double inv_z = 1 / double{samples_[begin].z_m};
  if (end - begin == 1) {
    addPoint({.inv_z = inv_z,
              .alpha = samples_[begin].alpha,
              .color = glm::dvec3(samples_[begin].color)});
    return;
  }
  Matter all;
  for (size_t i = begin; i < end; ++i) {
    const Matter matter = matterOf(samples_[i]);
    all.optical_depth += matter.optical_depth;
    all.emission += matter.emission;
    all.opaque_color += matter.opaque_color;
    all.opaque_count += matter.opaque_count;
  }
  addPoint(pointOf(all, inv_z));
}

void PixelTidier::addVolume(double begin_m, double end_m, const Matter& per_metre) {
  const double near = 1 / begin_m;
  const double far = 1 / end_m;
  const double count = std::clamp(std::ceil((near - far) / (kSliceShare * near)), 1.0, kSlicesMax);
  double slice_begin_m = begin_m;
  for (double i = 1; i <= count; ++i) {
    // The last ends exactly where the volume does: differences of 1/Z say little of thin ones.
    const double slice_end_m = i < count ? 1 / (near + (far - near) * (i / count)) : end_m;
    const double length_m = slice_end_m - slice_begin_m;
    addPoint(pointOf({.optical_depth = per_metre.optical_depth * length_m,
                      .emission = per_metre.emission * length_m},
                     0.5 / slice_begin_m + 0.5 / slice_end_m));
    slice_begin_m = slice_end_m;
  }
}

void PixelTidier::addPoint(const DeepPoint& point) {
  if (point.alpha > 0 || point.color != glm::dvec3(0)) points_.push_back(point);
}

}  // namespace viewloom::deep
