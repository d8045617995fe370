// SPDX-License-Identifier: Apache-2.0
// Which primaries a photo's colour profile means.
#pragma once

#include <optional>

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

}  // namespace viewloom::photos
