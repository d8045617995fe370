// SPDX-License-Identifier: Apache-2.0
// How long planes of strips take to pack, by plane and encoding.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "base/cost_estimate.h"
#include "encode/encoded_band.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class PackCosts {
 public:
  int64_t predictNs(const EncodingSpec& encoding, AtlasPlane plane, uint64_t px_count) const {
    return estimates_[placeOf(encoding, plane)].predictNs(px_count);
  }
  void note(const EncodingSpec& encoding, AtlasPlane plane, uint64_t px_count, int64_t time_ns) {
    estimates_[placeOf(encoding, plane)].note(px_count, time_ns);
  }
  // Time to code a picture of a video. Its planes were packed before, as kH264.
  int64_t predictCodingNs(uint64_t px_count) const { return coding_.predictNs(px_count); }
  void noteCoding(uint64_t px_count, int64_t time_ns) { coding_.note(px_count, time_ns); }

 private:
  static constexpr size_t kEncodings = kBandEncodingCount;
  static constexpr double kStart_ns = 20;  // a px

  static size_t placeOf(const EncodingSpec& encoding, AtlasPlane plane) {
    return isColor(plane) ? size_t(encoding.color) : kEncodings + size_t(encoding.planes);
  }
  template <size_t... kPlaces>
  static std::array<CostEstimate, sizeof...(kPlaces)> all(std::index_sequence<kPlaces...>) {
    return {((void)kPlaces, CostEstimate(kStart_ns))...};
  }

  std::array<CostEstimate, 2 * kEncodings> estimates_ =
      all(std::make_index_sequence<2 * kEncodings>());
  CostEstimate coding_{kStart_ns};
};

}  // namespace viewloom
