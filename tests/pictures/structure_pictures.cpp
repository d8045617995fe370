// SPDX-License-Identifier: Apache-2.0
#include "pictures/structure_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/str_cat.h"
#include "pictures/scene_to_draw.h"
#include "pictures/slice.h"

namespace viewloom::pictures {
namespace {

constexpr double kSample_px = 3;

PlainFacet facetAt(const StructureImage& structure, int layer, int column) {
  return readFacet(structure.layers[size_t(layer)].facets.at(column, kDrawnRow));
}

// Each facet of the row over its column.
void drawSurfaces(Slice& slice, const StructureImage& structure, std::string_view style) {
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    for (int column = 0; column < structure.width; ++column) {
      const PlainFacet facet = facetAt(structure, layer, column);
      if (!facet.exists) continue;
      const double half = 0.5 * double{facet.slope_x};
      slice.line(column, facet.inv_z - half, column + 1, facet.inv_z + half, ofLayer(style, layer));
    }
  }
}

// inv_z of a facet at the edge of its column.
double atEdge(const PlainFacet& facet, int side) {
  return double{facet.inv_z} + 0.5 * side * double{facet.slope_x};
}

// The edge of a facet to the left (-1) or to the right (1): what it is linked to, or how far down
// the silhouette goes.
void drawEdge(Slice& slice, const StructureImage& structure, int layer, int column, int side) {
  const PlainFacet facet = facetAt(structure, layer, column);
  const int edge_px = side > 0 ? column + 1 : column;
  if (!facet.exists || !slice.shows(edge_px)) return;
  const size_t index = size_t(kDrawnRow) * size_t(structure.width) + size_t(column);
  const int link = readLink(structure.layers[size_t(layer)].links[index], side > 0 ? 1 : 0);
  const double here = atEdge(facet, side);
  const bool is_linked = link > 0 && link <= int(structure.layers.size());
  const PlainFacet beside = facetAt(structure, is_linked ? link - 1 : layer, column + side);
  const double there = beside.exists ? atEdge(beside, -side) : 0;
  if (is_linked) {
    slice.svg().circle(slice.at(edge_px, 0.5 * (here + there)), kSample_px,
                       link - 1 == layer ? "link" : "across");
  } else if (here > there) {
    slice.line(edge_px, here, edge_px, there, "silhouette");
  }
}

// In steps, so that most px of a row are as those before.
std::string greyOf(double inv_z) {
  constexpr int kStep = 6;
  const int grey = std::clamp(int(std::lround((70 + 210 * inv_z) / kStep)) * kStep, 0, 255);
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", unsigned(grey), unsigned(grey),
                unsigned(grey));
  return text.data();
}

}  // namespace

std::string drawFacets(const StructureImage& structure) {
  Slice slice("Facets: each sample (dot) stands for a plane over its px");
  drawSurfaces(slice, structure, "layer");
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    for (int column = 0; column < structure.width; ++column) {
      const PlainFacet facet = facetAt(structure, layer, column);
      if (!facet.exists || !slice.shows(column + 0.5)) continue;
      slice.svg().circle(slice.at(column + 0.5, double{facet.inv_z}), kSample_px,
                         ofLayer("sample", layer));
    }
  }
  slice.note("Blue: layer 0. Orange: layer 1, known behind the board alone.");
  return slice.svg().file();
}

std::string drawLinks(const StructureImage& structure) {
  Slice slice("Links: facets whose edges meet are one surface; other edges are silhouettes");
  drawSurfaces(slice, structure, "thin");
  for (int layer = 0; layer < int(structure.layers.size()); ++layer) {
    for (int column = 1; column + 1 < structure.width; ++column) {
      for (const int side : {-1, 1}) drawEdge(slice, structure, layer, column, side);
    }
  }
  slice.note(
      "Rings: links. Filled: links from layer to layer. Dashed: silhouettes, which rays "
      "pass behind.");
  return slice.svg().file();
}

std::string drawNodes(const StructureImage& structure) {
  constexpr double kPx = 7;
  constexpr double kLeft_px = 14;
  constexpr double kTop_px = 34;
  Svg svg(int(kSceneSize_px * kPx + 2 * kLeft_px), int(kSceneSize_px * kPx + kTop_px + 42));
  svg.text({kLeft_px, 20}, "Nodes: where a walk of layer 0 enters", "");
  const LayerImage& layer = structure.layers.front();
  const auto place = [&](int column, int row) {
    return Point{kLeft_px + column * kPx, kTop_px + row * kPx};
  };
  const auto greyAt = [&](int column, int row) {
    return greyOf(double{readFacet(layer.facets.at(column, row)).inv_z});
  };
  for (int row = 0; row < structure.height; ++row) {
    for (int first = 0, end = 0; first < structure.width; first = end) {
      const std::string grey = greyAt(first, row);
      while (end < structure.width && greyAt(end, row) == grey) ++end;
      svg.box(place(first, row), (end - first) * kPx, kPx, "texel", grey);
    }
  }
  std::array<int, kLastNodeLevel + 1> plane_counts{};
  int box_count = 0;
  const auto outline = [&](int column, int row, int size, std::string_view style) {
    const Point corner = place(column, row);
    const Point end = place(column + size, row + size);
    svg.line(corner, {end.x, corner.y}, style);
    svg.line(corner, {corner.x, end.y}, style);
    svg.line({end.x, corner.y}, end, style);
    svg.line({corner.x, end.y}, end, style);
  };
  for (int row = 0; row < layer.entries.height; ++row) {
    for (int column = 0; column < layer.entries.width; ++column) {
      const PlainNode node = readNode(layer.entries.at(column, row));
      const int size = node.is_plane ? 1 << node.level : 1 << kFirstNodeLevel;
      const int x = column << kFirstNodeLevel;
      const int y = row << kFirstNodeLevel;
      if (x % size != 0 || y % size != 0) continue;
      outline(x, y, size, node.is_plane ? "plane" : "cells");
      if (node.is_plane) {
        ++plane_counts[size_t(node.level)];
      } else {
        ++box_count;
      }
    }
  }
  std::string planes = "White: planes";
  for (int level = kFirstNodeLevel; level <= kLastNodeLevel; ++level) {
    const int count = plane_counts[size_t(level)];
    if (count > 0) planes += strCat(", ", count, " of ", 1 << level, "x", 1 << level, " px");
  }
  const double below_px = kTop_px + kSceneSize_px * kPx;
  svg.text({kLeft_px, below_px + 18}, planes, "small");
  svg.text({kLeft_px, below_px + 32}, strCat("Red: boxes, ", box_count, " of 4x4 px"), "small");
  return svg.file();
}

}  // namespace viewloom::pictures
