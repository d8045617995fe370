// SPDX-License-Identifier: Apache-2.0
// Raw video without a header (.yuv), as MPEG's reference software reads and writes it.
#pragma once

#include <filesystem>

#include "files/plane_image.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// How many whole frames the file holds. INVALID_ARGUMENT when `raw` is none that can be, or when
// the file ends amid a frame.
absl::StatusOr<uint32_t> yuvFrameCount(const std::filesystem::path& path, const v1::RawVideo& raw);

// RGB8, by BT.709 in video range; chroma is that of the nearest sample.
absl::StatusOr<PlaneImage> readYuvColor(const std::filesystem::path& path, const v1::RawVideo& raw);

// DEPTH_U16: luma as stored.
absl::StatusOr<PlaneImage> readYuvDepth(const std::filesystem::path& path, const v1::RawVideo& raw);

}  // namespace viewloom::files
