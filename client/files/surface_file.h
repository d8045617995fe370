// SPDX-License-Identifier: Apache-2.0
// Planes that say how a surface mirrors and moves, as a manifest names them.
#pragma once

#include <filesystem>

#include "files/plane_file.h"

namespace viewloom::files {

// `kind`: NORMAL, ROUGHNESS, SPECULAR or MOTION. Normals come as XYZ16F, or XYZ8 of whole
// numbers of 8 bits; motion, of which whole numbers are refused, as XYZ16F; the others as R8 and
// RGB8, for which samples are brought into 0..1. Relative names begin at `folder`. INVALID_ARGUMENT
// with the field of the PlaneFile.
absl::StatusOr<LoadedPlane> loadSurfacePlane(const v1::PlaneFile& file,
                                             const std::filesystem::path& folder,
                                             v1::PlaneKind kind);

}  // namespace viewloom::files
