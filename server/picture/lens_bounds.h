// SPDX-License-Identifier: Apache-2.0
// How far rays through a lens go apart: the views from the corners of the square around it.
#pragma once

#include <glm/vec2.hpp>

#include "picture/trace_job.h"

namespace viewloom {

inline constexpr glm::dvec2 kLensCorners[] = {{-1, -1}, {-1, 1}, {1, -1}, {1, 1}};

// A camera of a layout with a lens as seen from a corner of the square around the lens before it.
Camera fromLensCorner(const Camera& camera, const AtlasLayout& layout, glm::dvec2 corner);

// Puts the lens before the tile of a view, whose tolerance becomes that of the outermost rays.
// The source sees source_px.
void addLens(const TraceJob& job, const Pose& display_pose, const Camera& source, SizePx source_px,
             const View& view, abi::ViewParams& tile);

// Adds those of all views, as they are without a filter, to job.lens_bounds.
void addLensBounds(TraceJob& job, const Pose& display_pose, const Camera& source, SizePx source_px);

}  // namespace viewloom
