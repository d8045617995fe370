// SPDX-License-Identifier: Apache-2.0
#include "gpu/structure_checks.h"

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>

#include "gpu/footprint.h"
#include "shared/structure_abi.h"

namespace viewloom {
namespace {

using oracle::FacetAt;
using oracle::OracleSource;

constexpr size_t kNamedCount = 3;

// The layer that the oracle links a facet to across an edge, as a link word states it.
int expectedLink(const OracleSource& source, const FacetAt& at, int edge) {
  constexpr std::array<std::array<int, 2>, 4> kSteps = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  FacetAt next{0, at.column + kSteps[size_t(edge)][0], at.row + kSteps[size_t(edge)][1]};
  if (next.column < 0 || next.column >= source.width()) return 0;
  if (next.row < 0 || next.row >= source.height()) return 0;
  for (; next.layer < source.layerCount(); ++next.layer) {
    if (source.linked(at, next)) return 1 + next.layer;
  }
  next.layer = at.layer;
  if (source.knownBehind(next, at)) return int(abi::kKnownBehind);
  return source.deepBehind(at, next) ? int(abi::kDeepEdge) : 0;
}

// Whether a link of the column leads from this layer or a deeper one to one before this layer.
bool leadsForward(const OracleSource& source, const FacetAt& at) {
  for (int layer = at.layer; layer < source.layerCount(); ++layer) {
    for (int edge = 0; edge < 4; ++edge) {
      const FacetAt from{layer, at.column, at.row};
      const int link = source.exists(from) ? expectedLink(source, from, edge) : 0;
      if (link > 0 && link < int(abi::kKnownBehind) && link - 1 < at.layer) return true;
    }
  }
  return false;
}

void checkFacet(const LayerImage& image, const OracleSource& source, const FacetAt& at,
                Complaints& complaints) {
  const size_t index = size_t(at.row) * size_t(source.width()) + size_t(at.column);
  const oracle::Facet& expected = source.facet(at);
  const PlainFacet facet = readFacet(image.facets.at(at.column, at.row));
  std::ostringstream place;
  place << placeOf(at.layer, 0, at.column, at.row) << ": ";
  const float facet_inv_z = facet.exists ? facet.inv_z : oracle::kNoSurface;
  if (image.inv_z[index] != expected.inv_z || facet_inv_z != expected.inv_z) {
    place << facet_inv_z << " instead of " << expected.inv_z;
    complaints.add("inv_z is not the oracle's", place.str());
  }
  if (expected.inv_z < 0) return;
  if (facet.slope_x != expected.slope_x || facet.slope_y != expected.slope_y) {
    place << "(" << facet.slope_x << ", " << facet.slope_y << ") instead of (" << expected.slope_x
          << ", " << expected.slope_y << ")";
    complaints.add("slopes are not the oracle's", place.str());
  }
  for (int edge = 0; edge < 4; ++edge) {
    const int link = expectedLink(source, at, edge);
    if (readLink(image.links[index], edge) == link) continue;
    place << "edge " << edge << " has " << readLink(image.links[index], edge) << " instead of "
          << link;
    complaints.add("links are not the oracle's", place.str());
  }
  if (facet.leads_forward != leadsForward(source, at)) {
    complaints.add("a facet does not tell of its links to the front", place.str());
  }
}

}  // namespace

Footprint footprintOf(const StructureImage& structure, int level, int column, int row) {
  const int size = 1 << level;
  return {column * size, row * size, std::min(structure.width, (column + 1) * size),
          std::min(structure.height, (row + 1) * size)};
}

std::string placeOf(int layer, int level, int column, int row) {
  std::ostringstream text;
  text << "layer " << layer << " level " << level << " (" << column << ", " << row << ")";
  return text.str();
}

void Complaints::add(const std::string& kind, const std::string& where) {
  auto found = std::find_if(kinds_.begin(), kinds_.end(),
                            [&](const Kind& known) { return known.name == kind; });
  if (found == kinds_.end()) found = kinds_.insert(found, {kind, 0, {}});
  ++found->count;
  if (found->first.size() < kNamedCount) found->first.push_back(where);
}

void Complaints::add(const Complaints& others) {
  for (const Kind& kind : others.kinds_) {
    for (const std::string& where : kind.first) add(kind.name, where);
  }
}

std::string Complaints::text() const {
  std::ostringstream text;
  for (const Kind& kind : kinds_) {
    text << kind.name << ": " << kind.count << " times";
    for (const std::string& where : kind.first) text << "\n  " << where;
    text << "\n";
  }
  return text.str();
}

void checkFacets(const StructureImage& structure, const OracleSource& source,
                 Complaints& complaints) {
  for (int layer = 0; layer < source.layerCount(); ++layer) {
    visitColumns({0, 0, source.width(), source.height()}, [&](int column, int row) {
      checkFacet(structure.layers[size_t(layer)], source, {layer, column, row}, complaints);
    });
  }
}

void checkEntries(const StructureImage& structure, Complaints& complaints) {
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    const LayerImage& image = structure.layers[size_t(layer)];
    for (int row = 0; row < image.entries.height; ++row) {
      for (int column = 0; column < image.entries.width; ++column) {
        PackedPair expected = image.levels.front().at(column, row);
        for (int level = 1; level < int(image.levels.size()); ++level) {
          const PackedPair ancestor = image.levels[size_t(level)].at(column >> level, row >> level);
          if (!readNode(expected).is_plane || !readNode(ancestor).is_plane) break;
          expected = ancestor;
        }
        if (image.entries.at(column, row) != expected) {
          complaints.add("an entry is not the largest plane of its cell",
                         placeOf(layer, kFirstNodeLevel, column, row));
        }
      }
    }
  }
}

Complaints checkStructure(const StructureImage& structure, const OracleSource& source) {
  Complaints complaints;
  checkFacets(structure, source, complaints);
  checkFirstLevel(structure, source, complaints);
  checkHigherLevels(structure, complaints);
  checkPlanes(structure, source, complaints);
  checkBoxes(structure, source, complaints);
  checkEntries(structure, complaints);
  return complaints;
}

double effectiveNodesPerPixel(const StructureImage& structure) {
  uint64_t count = 0;
  const LayerImage& layer = structure.layers.front();
  const std::function<void(int, int, int)> addNode = [&](int level, int column, int row) {
    const NodeGrid& grid = layer.levels[size_t(level - kFirstNodeLevel)];
    if (column >= grid.width || row >= grid.height) return;
    ++count;
    if (readNode(grid.at(column, row)).is_plane) return;
    if (level == kFirstNodeLevel) {
      visitColumns(footprintOf(structure, level, column, row), [&](int, int) { ++count; });
      return;
    }
    for (int child = 0; child < 4; ++child) {
      addNode(level - 1, 2 * column + (child & 1), 2 * row + (child >> 1));
    }
  };
  const NodeGrid& roots = layer.levels.back();
  for (int row = 0; row < roots.height; ++row) {
    for (int column = 0; column < roots.width; ++column) addNode(kLastNodeLevel, column, row);
  }
  return double(count) / (double(structure.width) * structure.height);
}

}  // namespace viewloom
