// SPDX-License-Identifier: Apache-2.0
// Pictures of H.264 that need no other, one below the other: the colour of a plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// One picture of a plane. Borrowed bytes.
struct StillPicture {
  std::span<const uint8_t> access_unit;  // from its sequence parameter set to its last slice
  SizePx size_px;                        // as that set says: even
};

// Slices of a picture. Each may go on to the end of the picture, over those that follow: so many
// times a picture may have to be decoded.
inline constexpr uint32_t kStillSlicesMax = 4;

// Size of all pictures of a plane together: even sides.
SizePx stillSize(SizePx plane_px);

// The pictures in an Annex B stream of any bytes, before anything of them is decoded. They cover
// `plane_px` from the top down, each as wide as stillSize. Each has one sequence parameter set,
// which comes first, and IDR slices of I macroblocks. Samples have full range and the weights of
// BT.601. INVALID_ARGUMENT for other bytes: what came, what is accepted, and what to do.
absl::StatusOr<std::vector<StillPicture>> stillPicturesOf(std::span<const uint8_t> stream,
                                                          SizePx plane_px);

}  // namespace viewloom
