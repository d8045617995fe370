// SPDX-License-Identifier: Apache-2.0
// Facets, links and nodes of the scene to draw, as the device built them.
#pragma once

#include <string>

#include "gpu/structure_image.h"

namespace viewloom::pictures {

// Each is an SVG file.
std::string drawFacets(const StructureImage& structure);
std::string drawLinks(const StructureImage& structure);
// From the front: the largest planes, and the boxes where there is none.
std::string drawNodes(const StructureImage& structure);

}  // namespace viewloom::pictures
