// SPDX-License-Identifier: Apache-2.0
#include "inputs/depth_conventions.h"

#include <Imath/half.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "base/str_cat.h"
#include "files/depth_packing.h"

namespace viewloom::inputs {
namespace {

constexpr float kHuge = 1e9F;  // beyond every scene

float sampleAt(const std::vector<uint8_t>& bytes, bool is_half, size_t index) {
  if (is_half) {
    uint16_t bits = 0;
    std::memcpy(&bits, &bytes[2 * index], sizeof bits);
    return Imath::half(Imath::half::FromBits, bits);
  }
  float sample = 0;
  std::memcpy(&sample, &bytes[4 * index], sizeof sample);
  return sample;
}

void putSample(std::vector<uint8_t>& bytes, bool is_half, size_t index, float sample) {
  if (is_half) {
    const uint16_t bits = Imath::half(sample).bits();
    std::memcpy(&bytes[2 * index], &bits, sizeof bits);
  } else {
    std::memcpy(&bytes[4 * index], &sample, sizeof sample);
  }
}

bool isHuge(float sample) {
  return std::abs(sample) >= kHuge;
}

}  // namespace

bool isRenderer(InputKind kind) {
  return kind == InputKind::kArnold || kind == InputKind::kVray || kind == InputKind::kRedshift ||
         kind == InputKind::kHoudini;
}

void settleRendererDepth(const InputSettings& settings, v1::Plane& plane, SharedBytes& bytes,
                         std::vector<std::string>& notes) {
  v1::DepthFormat& format = *plane.mutable_depth();
  const bool is_half = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16;
  const bool is_metric = format.meaning() == v1::DEPTH_MEANING_PLANAR ||
                         format.meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
  if (!is_metric || (!is_half && plane.encoding() != v1::PLANE_ENCODING_DEPTH_F32)) return;
  const size_t count = bytes->size() / (is_half ? 2 : 4);
  size_t negative_count = 0, positive_count = 0, huge_count = 0;
  float huge = 0;
  for (size_t i = 0; i < count; ++i) {
    const float sample = sampleAt(*bytes, is_half, i);
    if (isHuge(sample)) {
      ++huge_count;
      huge = sample;
    } else {
      negative_count += sample < 0;
      positive_count += sample > 0;
    }
  }
  const double scale = format.scale() == 0 ? 1 : format.scale();
  if (negative_count > positive_count && !settings.depth_scale && format.offset() == 0) {
    format.set_scale(-scale);
    notes.push_back(
        "depth is negative, as along +z behind the camera: turned over (--depth-scale)");
  }
  if (huge_count == 0 || settings.depth_invalid) return;
  const float far = format.scale() < 0 ? -std::numeric_limits<float>::infinity()
                                       : std::numeric_limits<float>::infinity();
  auto settled = std::make_shared<std::vector<uint8_t>>(*bytes);
  for (size_t i = 0; i < count; ++i) {
    if (isHuge(sampleAt(*bytes, is_half, i))) putSample(*settled, is_half, i, far);
  }
  bytes = std::move(settled);
  const double percent = std::round(1000.0 * double(huge_count) / double(count)) / 10;
  notes.push_back(strCat(percent, " % of the depth is ", huge,
                         " or similar, where the renderer hit nothing: read as infinitely far"));
}

namespace {

// Metres of the code 1; 0 for kinds that are no sensor.
double unitOf(InputKind kind) {
  switch (kind) {
    case InputKind::kSensor:
    case InputKind::kRecord3d:
      return 0.001;
    case InputKind::kKitti:
      return 1.0 / 256;
    case InputKind::kTum:
      return 1.0 / 5000;
    case InputKind::kL515:
      return 0.00025;
    case InputKind::kD405:
      return 0.0001;
    default:
      return 0;
  }
}

}  // namespace

bool isSensor(InputKind kind) {
  return unitOf(kind) != 0;
}

v1::DepthFormat sensorFormat(const InputSettings& settings, InputKind kind) {
  v1::DepthFormat format;
  const bool is_disparity = kind == InputKind::kKitti && settings.baseline_m;
  format.set_meaning(is_disparity ? v1::DEPTH_MEANING_DISPARITY : v1::DEPTH_MEANING_PLANAR);
  // Digits of a packed depth count as the whole number that they make.
  format.set_scale(unitOf(kind) * files::codeMaxOf(settings.depth_packing));
  format.set_invalid_value(0);
  return format;
}

void settleRecord3d(const InputSettings& settings, bool is_float, v1::DepthFormat& format) {
  if (is_float && !settings.depth_scale) format.set_scale(1);
}

void settleBaseline(double focal_px, double baseline_m, v1::DepthFormat& format) {
  const double scale = format.scale() == 0 ? 1 : format.scale();
  format.set_scale(scale / (focal_px * baseline_m));
  format.set_offset(format.offset() / (focal_px * baseline_m));
}

}  // namespace viewloom::inputs
