// SPDX-License-Identifier: Apache-2.0
// How a picture file says that its colour numbers relate to light.
#pragma once

#include <OpenEXR/ImfChromaticities.h>

#include <array>
#include <optional>

#include "viewloom/v1/frame.pb.h"

namespace viewloom::files {

struct ColorCoding {
  // stored = light ^ gamma; 1 is linear light. Nothing: the file does not say.
  std::optional<double> gamma;
  bool has_chromaticities = false;
  std::array<float, 8> xy{};      // of red, green, blue and white, in turn
  bool is_premultiplied = false;  // what alpha says, where there is one

  std::optional<Imf::Chromaticities> chromaticities() const;
};

// Light of a stored number, 0..1 and beyond.
class ToneCurve {
 public:
  // `stated` overrides the file; UNSPECIFIED leaves it to `coding`, and to `otherwise` where that
  // says nothing. Gammas that mean sRGB, as 1 / 2.2, are taken for it.
  ToneCurve(v1::ColorTransfer stated, const ColorCoding& coding, v1::ColorTransfer otherwise);

  bool isLinear() const { return gamma_ == 1; }
  bool isSrgb() const { return gamma_ == kSrgb; }
  float light(float stored) const;

 private:
  static constexpr double kSrgb = 0;

  double gamma_ = kSrgb;
};

}  // namespace viewloom::files
