// SPDX-License-Identifier: Apache-2.0
// Depth inside JPEG photos: Google's depth map in XMP, and Apple's auxiliary picture.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "files/jpeg_segments.h"
#include "files/picture.h"
#include "photos/photo_depth.h"

namespace viewloom::photos {

// The file of the depth picture inside a photo, and what its codes stand for; its size and its
// largest code are not known yet.
struct JpegDepth {
  PhotoDepth depth;
  bool is_png = false;
  std::string bytes;
};

// GDepth (http://ns.google.com/photos/1.0/depthmap/): base64 of a JPEG or PNG in extended XMP,
// whose codes lie between Near and Far. Else the first picture of the multi-picture index whose own
// XMP calls it disparity or depth. Nothing without depth.
std::optional<JpegDepth> findJpegDepth(std::span<const uint8_t> bytes,
                                       const files::JpegSegments& segments);

// The depth picture, turned as the photo is. Completes `found.depth`.
absl::StatusOr<files::Picture> decodeJpegDepth(const std::string& name, JpegDepth& found,
                                               uint32_t orientation);

}  // namespace viewloom::photos
