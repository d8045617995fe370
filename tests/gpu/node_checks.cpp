// SPDX-License-Identifier: Apache-2.0
// The checks of structure_checks.h that look at nodes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "gpu/footprint.h"
#include "gpu/structure_checks.h"
#include "shared/structure_abi.h"

namespace viewloom {
namespace {

using oracle::FacetAt;
using oracle::OracleSource;

constexpr float kNothing = -1.0f;  // the upper bound of a box without a surface

// Tightness of a first-level box, outward. In ulp of the upper bound: half an ulp of rounding each
// in half the range of a facet, in the bound made from it and in adding the margin, and the margin
// itself, 2^-23 of the upper bound and so less than 2: 3.5 together. The lower bound also gives up
// the 3 bits that hold the level: up to 7 of its own ulp.
constexpr int kBoxUlps = 4;
constexpr int kDroppedUlps = 7;

struct Bounds {
  double low = 0;
  double high = 0;
};

// Exact bounds of a facet over its footprint, never below the sky.
Bounds boundsOf(const oracle::Facet& facet) {
  const double half_range =
      0.5 * (std::abs(double(facet.slope_x)) + std::abs(double(facet.slope_y)));
  return {std::max(0.0, double(facet.inv_z) - half_range), double(facet.inv_z) + half_range};
}

double ulpsOf(double value, int count) {
  const float nearest = float(value);
  return count * double(std::nextafter(nearest, INFINITY) - nearest);
}

struct NodePlace {
  int layer = 0;
  int level = 0;
  int column = 0;
  int row = 0;

  std::string name() const { return placeOf(layer, level, column, row); }
};

template <typename Visit>
void visitNodes(const StructureImage& structure, int first_level, int last_level, Visit visit) {
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    for (int level = first_level; level <= last_level; ++level) {
      const NodeGrid& grid =
          structure.layers[size_t(layer)].levels[size_t(level - kFirstNodeLevel)];
      for (int row = 0; row < grid.height; ++row) {
        for (int column = 0; column < grid.width; ++column) {
          visit(NodePlace{layer, level, column, row}, readNode(grid.at(column, row)));
        }
      }
    }
  }
}

Footprint footprintOf(const StructureImage& structure, const NodePlace& place) {
  return footprintOf(structure, place.level, place.column, place.row);
}

// Box of what a node may hold, as the node format states it: binary32, one rounding per operation.
void boxOf(const PlainNode& node, float& low, float& high) {
  low = node.low;
  high = node.high;
  if (!node.is_plane) return;
  constexpr float kTwoUlp = 2.384185791015625e-7f;
  const float half_size = 0.5f * float(1 << node.level);
  const float half_range =
      (half_size * (std::abs(node.slope_x) + std::abs(node.slope_y)) + node.error) *
      (1.0f + kTwoUlp);
  low = std::max(0.0f, (node.inv_z - half_range) * (1.0f - kTwoUlp));
  high = (node.inv_z + half_range) * (1.0f + kTwoUlp);
}

// How far the facets of a footprint stand from a plane at most, at the corners of their footprints.
double distanceFromPlane(const OracleSource& source, int layer, const Footprint& footprint,
                         const PlainNode& node, double center_x, double center_y) {
  double distance = 0;
  visitColumns(footprint, [&](int column, int row) {
    for (int corner = 0; corner < 4; ++corner) {
      const double x = column + (corner & 1), y = row + (corner >> 1);
      const double plane = double(node.inv_z) + double(node.slope_x) * (x - center_x) +
                           double(node.slope_y) * (y - center_y);
      distance = std::max(distance, std::abs(source.planeInvZ({layer, column, row}, x, y) - plane));
    }
  });
  return distance;
}

bool isWholeAndConnected(const OracleSource& source, int layer, const Footprint& footprint) {
  bool connected = true;
  visitColumns(footprint, [&](int column, int row) {
    const FacetAt at{layer, column, row};
    if (!source.exists(at)) connected = false;
    if (!connected) return;
    const FacetAt right{layer, column + 1, row}, below{layer, column, row + 1};
    if (right.column < footprint.right && !source.linked(at, right)) connected = false;
    if (below.row < footprint.bottom && !source.linked(at, below)) connected = false;
  });
  return connected;
}

// The nearest of the lower layers that a facet or one behind it is linked to, anywhere on its
// edges; 0 without such a link. A walk in this layer must look at such an edge.
double nearestForward(const StructureImage& structure, const OracleSource& source,
                      const FacetAt& at) {
  constexpr std::array<std::array<int, 2>, 4> kSteps = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  const size_t index = size_t(at.row) * size_t(structure.width) + size_t(at.column);
  double nearest = 0;
  const int edge_count = 4 * (source.layerCount() - at.layer);
  for (int count = 0; count < edge_count; ++count) {
    const int edge = count % 4;
    const int link = readLink(structure.layers[size_t(at.layer + count / 4)].links[index], edge);
    if (link == 0 || link >= int(abi::kKnownBehind) || link - 1 >= at.layer) continue;
    const auto& [step_x, step_y] = kSteps[size_t(edge)];
    const FacetAt linked{link - 1, at.column + step_x, at.row + step_y};
    const double middle_x = at.column + 0.5 + 0.5 * step_x;
    const double middle_y = at.row + 0.5 + 0.5 * step_y;
    const oracle::Facet& facet = source.facet(linked);
    const double lean = 0.5 * std::abs(double(step_x != 0 ? facet.slope_y : facet.slope_x));
    nearest = std::max(nearest, source.planeInvZ(linked, middle_x, middle_y) + lean);
  }
  return nearest;
}

// Content that a box of the first level has to hold.
struct BlockContent {
  Bounds bounds{INFINITY, double{kNothing}};
  double raised = 0;  // how far up it must reach to what is linked in front, 1/m
  bool has_hole = false;
};

BlockContent contentOf(const StructureImage& structure, const OracleSource& source,
                       const NodePlace& place) {
  BlockContent content;
  visitColumns(footprintOf(structure, place), [&](int column, int row) {
    const oracle::Facet& facet = source.facet({place.layer, column, row});
    if (facet.inv_z < 0) {
      content.has_hole = true;
      return;
    }
    const Bounds bounds = boundsOf(facet);
    content.bounds.low = std::min(content.bounds.low, bounds.low);
    content.bounds.high = std::max(content.bounds.high, bounds.high);
    content.raised =
        std::max(content.raised, nearestForward(structure, source, {place.layer, column, row}));
  });
  return content;
}

}  // namespace

void checkFirstLevel(const StructureImage& structure, const OracleSource& source,
                     Complaints& complaints) {
  visitNodes(structure, kFirstNodeLevel, kFirstNodeLevel,
             [&](const NodePlace& place, const PlainNode& node) {
               if (node.is_plane) return;
               const BlockContent content = contentOf(structure, source, place);
               const Bounds& bounds = content.bounds;
               if (bounds.high < 0) {
                 if (node.high != kNothing) {
                   complaints.add("an empty box holds something", place.name());
                 }
                 return;
               }
               if (content.has_hole && node.low != 0) {
                 complaints.add("a box with a hole has a floor", place.name());
               }
               const double low_reach =
                   ulpsOf(bounds.high, kBoxUlps) + ulpsOf(bounds.low, kDroppedUlps);
               if (!content.has_hole && double(node.low) < bounds.low - low_reach) {
                 complaints.add("a first-level box reaches too far down", place.name());
               }
               if (double(node.high) < content.raised) {
                 complaints.add("a first-level box hides what is linked in front", place.name());
               }
               const double high_reach = ulpsOf(bounds.high, kBoxUlps);
               if (content.raised == 0 && double(node.high) > bounds.high + high_reach) {
                 complaints.add("a first-level box reaches too far up", place.name());
               }
             });
}

void checkHigherLevels(const StructureImage& structure, Complaints& complaints) {
  visitNodes(
      structure, kFirstNodeLevel + 1, kLastNodeLevel,
      [&](const NodePlace& place, const PlainNode& node) {
        const NodeGrid& below =
            structure.layers[size_t(place.layer)].levels[size_t(place.level - 1 - kFirstNodeLevel)];
        float low = INFINITY, high = kNothing;
        bool all_planes = true;
        for (int child = 0; child < 4; ++child) {
          const int column = 2 * place.column + (child & 1);
          const int row = 2 * place.row + (child >> 1);
          if (column >= below.width || row >= below.height) continue;
          const PlainNode child_node = readNode(below.at(column, row));
          all_planes = all_planes && child_node.is_plane;
          float child_low = 0, child_high = 0;
          boxOf(child_node, child_low, child_high);
          low = std::min(low, child_low);
          high = std::max(high, child_high);
        }
        if (node.level != place.level) {
          complaints.add("a node states another level", place.name());
        }
        if (node.is_plane && !all_planes) {
          complaints.add("a plane spans what is not planar", place.name());
        }
        if (node.is_plane) return;
        const float kept_low = std::bit_cast<float>(std::bit_cast<uint32_t>(low) & ~7u);
        if (node.low != kept_low || node.high != high) {
          complaints.add("a box does not follow from the level below", place.name());
        }
      });
}

void checkPlanes(const StructureImage& structure, const OracleSource& source,
                 Complaints& complaints) {
  visitNodes(structure, kFirstNodeLevel, kLastNodeLevel,
             [&](const NodePlace& place, const PlainNode& node) {
               if (!node.is_plane) return;
               const Footprint footprint = footprintOf(structure, place);
               if (!isWholeAndConnected(source, place.layer, footprint)) {
                 complaints.add("a plane spans holes or silhouettes", place.name());
                 return;
               }
               const double size = 1 << place.level;
               const double distance =
                   distanceFromPlane(source, place.layer, footprint, node,
                                     (place.column + 0.5) * size, (place.row + 0.5) * size);
               if (distance > double(node.error)) {
                 complaints.add("a plane is off by more than it states", place.name());
               }
               double largest = 0;
               visitColumns(footprint, [&](int column, int row) {
                 const oracle::Facet& facet = source.facet({place.layer, column, row});
                 largest = std::max(largest, boundsOf(facet).high);
               });
               if (double(node.error) > 0.5 * source.kappa().at(largest)) {
                 complaints.add("a plane states more than kappa / 2", place.name());
               }
             });
}

void checkBoxes(const StructureImage& structure, const OracleSource& source,
                Complaints& complaints) {
  visitNodes(structure, kFirstNodeLevel, kLastNodeLevel,
             [&](const NodePlace& place, const PlainNode& node) {
               float low = 0, high = 0;
               boxOf(node, low, high);
               bool encloses = true;
               visitColumns(footprintOf(structure, place), [&](int column, int row) {
                 const oracle::Facet& facet = source.facet({place.layer, column, row});
                 const Bounds bounds = boundsOf(facet);
                 if (facet.inv_z < 0) {
                   encloses = encloses && !node.is_plane && low == 0;
                 } else {
                   encloses = encloses && double(low) <= bounds.low && double(high) >= bounds.high;
                 }
               });
               if (!encloses) complaints.add("a node does not enclose its facets", place.name());
             });
}

}  // namespace viewloom
