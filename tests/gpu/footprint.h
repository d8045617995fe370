// SPDX-License-Identifier: Apache-2.0
// Which px a node covers, and how places are named in complaints.
#pragma once

#include <string>

#include "gpu/structure_image.h"

namespace viewloom {

struct Footprint {
  int left, top, right, bottom;  // px, right and bottom excluded
};

Footprint footprintOf(const StructureImage& structure, int level, int column, int row);
std::string placeOf(int layer, int level, int column, int row);

template <typename Visit>
void visitColumns(const Footprint& footprint, Visit visit) {
  for (int row = footprint.top; row < footprint.bottom; ++row) {
    for (int column = footprint.left; column < footprint.right; ++column) visit(column, row);
  }
}

}  // namespace viewloom
