// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "base/str_cat.h"
#include "inspect/suspicions.h"

namespace viewloom::inspect {
namespace {

// Alpha of less, as of one code of 8 bits, is none; colour of less is black.
constexpr float kAlphaMin = 0.02F;
constexpr float kLightMin = 0.02F;
constexpr double kEverywhere = 0.98;
constexpr double kNoticed = 0.05;

struct Light {
  float color;  // the brightest channel
  float alpha;
};

Light lightAt(const v1::Plane& color, const std::vector<uint8_t>& bytes, size_t index) {
  if (color.encoding() == v1::PLANE_ENCODING_RGBA8) {
    const uint8_t* const px = &bytes[4 * index];
    return {float(*std::max_element(px, px + 3)) / 255, float(px[3]) / 255};
  }
  uint16_t halves[4];
  std::memcpy(halves, &bytes[8 * index], sizeof(halves));
  float brightest = 0;
  for (int i = 0; i < 3; ++i) brightest = std::max(brightest, glm::unpackHalf1x16(halves[i]));
  return {brightest, glm::unpackHalf1x16(halves[3])};
}

}  // namespace

AlphaMeasures measureAlpha(const v1::Plane& color, const std::vector<uint8_t>& bytes,
                           const DepthSamples& samples) {
  AlphaMeasures measures;
  const bool has_alpha = color.encoding() == v1::PLANE_ENCODING_RGBA8 ||
                         color.encoding() == v1::PLANE_ENCODING_RGBA16F;
  const bool is_used =
      color.alpha() == v1::ALPHA_MODE_PREMULTIPLIED || color.alpha() == v1::ALPHA_MODE_STRAIGHT;
  if (!has_alpha || !is_used) return measures;
  measures.is_ignored = false;
  const uint64_t width = color.size().width(), height = color.size().height();
  for (uint32_t y = 0; y < samples.height_px; ++y) {
    const uint64_t row = (2 * uint64_t{y} + 1) * height / (2 * uint64_t{samples.height_px});
    for (uint32_t x = 0; x < samples.width_px; ++x) {
      // Beyond, renderers hit nothing: it may well be transparent.
      if (!(samples.inv_z[size_t{y} * samples.width_px + x] > 1 / kHuge)) continue;
      ++measures.surface_count;
      const uint64_t column = (2 * uint64_t{x} + 1) * width / (2 * uint64_t{samples.width_px});
      const Light light = lightAt(color, bytes, row * width + column);
      if (light.alpha > kAlphaMin) continue;
      ++measures.transparent_count;
      if (light.color > kLightMin) ++measures.lit_count;
    }
  }
  return measures;
}

std::vector<Suspicion> suspectAlpha(const v1::Plane& color, const AlphaMeasures& measures) {
  if (measures.is_ignored || measures.surface_count == 0) return {};
  const auto all = double(measures.surface_count);
  const double lit_percent = std::round(1000 * double(measures.lit_count) / all) / 10;
  if (double(measures.transparent_count) >= kEverywhere * all) {
    return {{.kind = "alpha",
             .sentence = strCat("alpha is 0, or almost, on ",
                                std::round(1000 * double(measures.transparent_count) / all) / 10,
                                " % of the surfaces: views see through them",
                                measures.lit_count == 0 ? ", and their colour is black" : ""),
             .remedy = {}}};
  }
  const bool only_adds = color.alpha() == v1::ALPHA_MODE_PREMULTIPLIED;
  if (!only_adds || double(measures.lit_count) < kNoticed * all) return {};
  return {{.kind = "alpha",
           .sentence = strCat(lit_percent,
                              " % of the surfaces have colour, but an alpha of 0: views see "
                              "through them"),
           .remedy = {}}};
}

}  // namespace viewloom::inspect
