// SPDX-License-Identifier: Apache-2.0
// The auxiliary image of a photo that holds its depth, and what its codes stand for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "photos/depth_xmp.h"
#include "photos/heif_image.h"

namespace viewloom::photos {

enum class CodeQuantity {
  kDisparity,  // codes are linear in 1/Z
  kDistance,   // codes are linear in Z, metres along the view axis
};

// Meaning of code 0 and of the largest code: 1/m or m, both finite.
struct CodeEnds {
  double at_zero = 0;
  double at_most = 0;
};

struct PhotoDepth {
  uint32_t width_px = 0;  // as shown, turned like the photo
  uint32_t height_px = 0;
  uint32_t code_max = 255;
  std::string type;  // as the file names it: "urn:mpeg:hevc:2015:auxid:2"
  CodeQuantity quantity = CodeQuantity::kDisparity;
  std::optional<CodeEnds> ends;  // where the file has numbers
  std::string origin;            // which part of the file the numbers are from
  bool is_relative = false;      // the file calls its numbers relative
};

struct FoundDepth {
  HeifOwned<heif_image_handle> image;  // null without depth
  PhotoDepth depth;
  std::vector<std::string> other_types;  // of auxiliary images that are no depth
};

// Reads the meaning of codes from Apple's XMP; its numbers count for `depth.code_max`.
void readDepthXmp(const DepthXmp& xmp, PhotoDepth& depth);

// The first auxiliary image whose type is depth, or whose XMP says that it is disparity or depth.
// Numbers come from Apple's XMP; else from the depth representation information (ITU-T H.265,
// annex G): Z near and far, or the least and largest disparity, taken as 1/m, which is what phones
// put there.
FoundDepth findDepth(const heif_image_handle* photo);

}  // namespace viewloom::photos
