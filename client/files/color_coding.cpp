// SPDX-License-Identifier: Apache-2.0
#include "files/color_coding.h"

#include <cmath>

#include "base/srgb.h"

namespace viewloom::files {
namespace {

// Files state 1 / 2.2 (0.45455) or 1 / 2.4 for sRGB and BT.709; the nearest other in use is
// 1 / 1.8 (0.556).
constexpr double kSrgbGamma = 1 / 2.2;
constexpr double kSrgbReach = 0.04;
constexpr double kLinearReach = 0.01;

}  // namespace

std::optional<Imf::Chromaticities> ColorCoding::chromaticities() const {
  if (!has_chromaticities) return std::nullopt;
  const auto at = [&](size_t i) { return Imath::V2f(xy[i], xy[i + 1]); };
  return Imf::Chromaticities(at(0), at(2), at(4), at(6));
}

ToneCurve::ToneCurve(v1::ColorTransfer stated, const ColorCoding& coding,
                     v1::ColorTransfer otherwise) {
  if (stated == v1::COLOR_TRANSFER_UNSPECIFIED && coding.gamma) {
    const bool is_linear = std::abs(*coding.gamma - 1) <= kLinearReach;
    const bool is_srgb = std::abs(*coding.gamma - kSrgbGamma) <= kSrgbReach;
    gamma_ = is_linear ? 1 : is_srgb ? kSrgb : *coding.gamma;
    return;
  }
  const v1::ColorTransfer transfer = stated == v1::COLOR_TRANSFER_UNSPECIFIED ? otherwise : stated;
  if (transfer == v1::COLOR_TRANSFER_LINEAR) gamma_ = 1;
}

float ToneCurve::light(float stored) const {
  if (isLinear() || stored <= 0) return stored;
  if (!isSrgb()) return static_cast<float>(std::pow(double{stored}, 1 / gamma_));
  return static_cast<float>(linearFromSrgb(stored));
}

}  // namespace viewloom::files
