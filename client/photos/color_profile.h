// SPDX-License-Identifier: Apache-2.0
// Which primaries a photo's colour profile means.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "photos/heif_handles.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom::photos {

struct ColorProfile {
  bool is_stated = false;
  std::optional<v1::ColorPrimaries> primaries;  // stated ones, where the wire knows them
  bool is_hdr = false;                          // stated as PQ or HLG
};

// ICC where the photo has one, else nclx; an nclx that leaves its primaries open states nothing.
ColorProfile colorProfileOf(const heif_image_handle* image);

// By the colorants rXYZ, gXYZ and bXYZ of a matrix profile. Nothing where they are of none of the
// primaries that the wire knows, or are no colorants.
std::optional<v1::ColorPrimaries> primariesOfIcc(std::span<const uint8_t> profile);

}  // namespace viewloom::photos
