// SPDX-License-Identifier: Apache-2.0
// Gives the pictures of any H.264 encoder the form that those of OpenH264Encoder have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// A sequence parameter set of main profile, from its type byte on, with the constraints, the level,
// the colour and the order that codedVideoString() and OpenH264Encoder say. What slices depend on
// stays. FAILED_PRECONDITION for a set that would not be true then: another profile or size,
// fields, or more than one reference.
absl::StatusOr<std::vector<uint8_t>> uniformParameterSet(std::span<const uint8_t> unit,
                                                         SizePx size_px);

// Replaces the content of `access_unit` by a coded picture: its parameter sets if it is an IDR
// picture, and its slices. Delimiters and supplements are left out. FAILED_PRECONDITION if it is no
// whole picture, or no IDR picture although `is_idr`, and as uniformParameterSet.
absl::Status writeUniformUnit(std::span<const uint8_t> coded, SizePx size_px, bool is_idr,
                              std::vector<uint8_t>& access_unit);

}  // namespace viewloom
