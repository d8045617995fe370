// SPDX-License-Identifier: Apache-2.0
// The pixels of a colour plane, whatever its encoding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/status.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom::inspect {

using Rgb = std::array<uint8_t, 3>;  // sRGB

// Thread-safety: const methods may be called from any thread.
class ColorPixels {
 public:
  // `bytes` must outlive it. JPEG is decoded; an error says what is wrong with it.
  static absl::StatusOr<ColorPixels> open(v1::Plane plane, const std::vector<uint8_t>& bytes);

  // `x_share`, `y_share`: of the sides, 0 to below 1.
  Rgb at(double x_share, double y_share) const;

 private:
  ColorPixels(v1::Plane plane, const std::vector<uint8_t>& bytes)
      : plane_(std::move(plane)), bytes_(&bytes) {}
  const std::vector<uint8_t>& bytes() const { return decoded_.empty() ? *bytes_ : decoded_; }
  Rgb linearAt(size_t offset) const;

  v1::Plane plane_;
  const std::vector<uint8_t>* bytes_;
  std::vector<uint8_t> decoded_;  // of JPEG
};

}  // namespace viewloom::inspect
