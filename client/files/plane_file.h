// SPDX-License-Identifier: Apache-2.0
// A plane as a manifest names it: read from its file and described for the wire.
#pragma once

#include <filesystem>
#include <optional>

#include "base/byte_pool.h"
#include "base/status.h"
#include "files/exr_header.h"
#include "files/plane_image.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// The px that a manifest names; none = the display window.
std::optional<ExrWindow> exrWindow(const v1::ExrWindow& window);

struct LoadedPlane {
  v1::Plane plane;  // complete but for compression
  SharedBytes bytes;
  uint32_t code_max = 0;  // as PlaneImage
};

// The file's px as colour, and how they are described for the wire. `folder`: where relative names
// begin.
absl::StatusOr<PlaneImage> readColorImage(const v1::PlaneFile& file,
                                          const std::filesystem::path& folder);
LoadedPlane withBytes(PlaneImage image, v1::PlaneKind kind);

// Relative file names are taken from `folder`. What the manifest leaves open comes from the file:
// transfer by what it says, else LINEAR for floats and SRGB for whole numbers; alpha PREMULTIPLIED
// for EXR and TIFF that say so, else STRAIGHT, or OPAQUE without it.
absl::StatusOr<LoadedPlane> loadColorPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder);
// Samples of 8 bits count 0..255, or, as WINDOW depth, 0..1.
absl::StatusOr<LoadedPlane> loadDepthPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder);

// The same planes from what a file gave that is read elsewhere.
absl::StatusOr<LoadedPlane> makeColorPlane(const v1::PlaneFile& file, PlaneImage image);
LoadedPlane makeDepthPlane(const v1::PlaneFile& file, PlaneImage image);

}  // namespace viewloom::files
