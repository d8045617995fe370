// SPDX-License-Identifier: Apache-2.0
// Invariants of every structure, checked against the oracle and the structure's own lower levels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/structure_image.h"
#include "oracle/oracle_source.h"

namespace viewloom {

// Violations in words: the first few cases of each kind, and how many there are.
class Complaints {
 public:
  void add(const std::string& kind, const std::string& where);
  void add(const Complaints& others);
  bool empty() const { return kinds_.empty(); }
  std::string text() const;

 private:
  struct Kind {
    std::string name;
    uint64_t count = 0;
    std::vector<std::string> first;
  };
  std::vector<Kind> kinds_;
};

// inv_z, facets and links are the oracle's, bit by bit.
void checkFacets(const StructureImage& structure, const oracle::OracleSource& source,
                 Complaints& complaints);
// Nodes of the first level enclose the oracle's facets, outward and tightly.
void checkFirstLevel(const StructureImage& structure, const oracle::OracleSource& source,
                     Complaints& complaints);
// Each further level follows from the one below it as read back: boxes bit by bit.
void checkHigherLevels(const StructureImage& structure, Complaints& complaints);
// Planes of every level are within their stated error at every px they cover, span connected facets
// only, and never state more than half of kappa.
void checkPlanes(const StructureImage& structure, const oracle::OracleSource& source,
                 Complaints& complaints);
// Boxes of every level hold every facet they cover.
void checkBoxes(const StructureImage& structure, const oracle::OracleSource& source,
                Complaints& complaints);
// An entry is its cell's largest planar ancestor, else the cell's own node.
void checkEntries(const StructureImage& structure, Complaints& complaints);

Complaints checkStructure(const StructureImage& structure, const oracle::OracleSource& source);

// Nodes per px of layer 0 that nothing larger replaces: the largest planes, and the boxes that no
// plane covers with the facets below the smallest of them.
double effectiveNodesPerPixel(const StructureImage& structure);

}  // namespace viewloom
