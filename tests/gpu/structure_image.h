// SPDX-License-Identifier: Apache-2.0
// A structure as read back from the device, and its packed words read by their documented format
// alone (shaders/shared/structure_abi.h, shaders/lib/structure): no code is shared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viewloom {

constexpr int kFirstNodeLevel = 2;
constexpr int kLastNodeLevel = 6;

struct PackedPair {
  uint32_t x = 0;
  uint32_t y = 0;
  bool operator==(const PackedPair&) const = default;
};

struct NodeGrid {
  int width = 0;
  int height = 0;
  std::vector<PackedPair> nodes;  // [height][width]

  const PackedPair& at(int column, int row) const {
    return nodes[size_t(row) * size_t(width) + size_t(column)];
  }
};

struct LayerImage {
  std::vector<float> inv_z;  // [height][width]
  NodeGrid facets;
  std::vector<uint16_t> links;  // [height][width]
  NodeGrid entries;
  std::vector<NodeGrid> levels;  // [level - kFirstNodeLevel]
};

struct StructureImage {
  int width = 0;
  int height = 0;
  std::vector<LayerImage> layers;
};

struct PlainFacet {
  bool exists = false;
  bool leads_forward = false;  // a link of it or of one behind it does, to one before it
  float inv_z = 0;
  float slope_x = 0;
  float slope_y = 0;
};

struct PlainNode {
  bool is_plane = false;
  int level = 0;
  // Plane: inv_z at the centre of its block, slopes per px and its error, 1/m.
  float inv_z = 0;
  float slope_x = 0;
  float slope_y = 0;
  float error = 0;
  // Box: least and largest inv_z, 1/m.
  float low = 0;
  float high = 0;
};

PlainFacet readFacet(const PackedPair& bits);
PlainNode readNode(const PackedPair& bits);
// 0 = silhouette, 1 + k = linked to layer k; edge: 0 left, 1 right, 2 top, 3 bottom.
int readLink(uint16_t links, int edge);

}  // namespace viewloom
