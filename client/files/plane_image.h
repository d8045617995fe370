// SPDX-License-Identifier: Apache-2.0
// One plane as a file gave it, in an encoding of the wire, and which primaries its colour has.
#pragma once

#include <OpenEXR/ImfChromaticities.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom::files {

inline constexpr int64_t kSideMax_px = 8192;  // of a plane, as the server accepts
inline constexpr float kHalfMax = 65504;      // the largest finite number of binary16

struct PlaneImage {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  v1::PlaneEncoding encoding = v1::PLANE_ENCODING_UNSPECIFIED;
  v1::ColorTransfer transfer = v1::COLOR_TRANSFER_UNSPECIFIED;  // of 8 bits, where it is not sRGB
  bool has_alpha = false;
  bool is_premultiplied = false;  // by the file, where there is alpha
  uint32_t code_max = 0;          // whole numbers: the code of white, else 0; packed depth: 1
  std::optional<Imf::Chromaticities> chromaticities;  // colour whose file states them
  std::vector<uint8_t> bytes;                         // packed, top row first
};

// Refuses what no plane may be, before memory is spent on it.
absl::Status checkPlaneSize(const std::string& file, int64_t width_px, int64_t height_px);

// Which of the primaries that the wire knows they are, all with white D65; nothing for others, as
// ACEScg.
std::optional<v1::ColorPrimaries> knownPrimaries(const Imf::Chromaticities& chromaticities);

// The primaries of a RGBA16F image: those that its file states, BT709 without. The colour of
// unknown ones is converted to BT2020, its white adapted to D65 (Bradford). Chromaticities that
// span no colours are refused.
absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file, PlaneImage& image);
// The same for RGBA16F px alone.
absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file,
                                                   const Imf::Chromaticities& stated,
                                                   std::vector<uint8_t>& rgba16f);

}  // namespace viewloom::files
