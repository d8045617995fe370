// SPDX-License-Identifier: Apache-2.0
// True pictures and covered masks from files, in the form they are scored in.
#pragma once

#include <filesystem>
#include <vector>

#include "base/status.h"
#include "scoring/image_score.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom {

// A true picture, or any other colour plane. Colour with alpha is set on black.
absl::StatusOr<ScoredImage> loadScoredImage(const v1::PlaneFile& file,
                                            const std::filesystem::path& folder,
                                            ScoreTransfer transfer);

// An 8-bit grey PNG: 255 = a source pixel covers this pixel, 0 = none does, anything between =
// outside the source's image.
absl::StatusOr<std::vector<PixelClass>> loadCoveredMask(const std::filesystem::path& path,
                                                        SizePx size_px);

}  // namespace viewloom
