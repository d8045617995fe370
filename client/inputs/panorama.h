// SPDX-License-Identifier: Apache-2.0
// Panoramas as cube maps, the only sources around a camera that the wire knows.
#pragma once

#include <string>

#include "base/status.h"
#include "files/frame_manifest.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// Turns the frame's only source, one layer of colour and depth, into a cube map whose last face,
// -z, shows the middle of an equirectangular picture, or the +z face of OpenEXR's cube. Colour is
// mixed between px, depth is not. Faces of an equirectangular picture W px wide have W / pi px a
// side: as many px a degree in their middle. Metric depth of it counts along the ray, whether it
// is called ray or planar. Depth becomes PLANAR or DISPARITY of each face; alpha is left out.
// Errors name the file.
absl::Status makeCubeMap(const std::string& file, Projection projection, files::LoadedFrame& frame);

}  // namespace viewloom::inputs
