// SPDX-License-Identifier: Apache-2.0
// The surfaces that rays of one row meet: what a sweep paints.
#pragma once

#include <array>
#include <cstdint>

#include "frame/surface_steps.h"
#include "shared/structure_abi.h"
#include "sweep/aligned_array.h"

namespace viewloom {

template <typename T>
using ByLayer = std::array<T, abi::kLayerCountMax>;

// Positions among the texels of a row, and steps of colour: 1/256 px, as in lib/light/color.glsl.
inline constexpr int kSubtexelSteps = 256;

// Straight pieces of the connected surfaces of a layer, each surface from left to right.
struct Runs {
  uint32_t count = 0;
  AlignedArray<float> begin_px;  // in the source
  AlignedArray<float> end_px;
  AlignedArray<float> begin_inv_z;  // 1/m
  AlignedArray<float> end_inv_z;
  // A place x px stands for 256 x + texel_offset among the texels.
  AlignedArray<int32_t> texel_offset;

  void reserve(uint32_t run_count);
};

// In place of a position among the texels.
inline constexpr int32_t kNoTexel = -1;
inline constexpr int32_t kBackgroundTexel = -2;

// Edges between columns where surfaces end or step, as rays meet them that travel one way.
// A ray that crosses an edge with an inv_z in (low, high] meets it.
struct Steps {
  uint32_t count = 0;
  AlignedArray<float> edge_px;
  AlignedArray<float> low_inv_z;
  AlignedArray<float> high_inv_z;
  // Where the colour is: of bridges that of the edge; of silhouettes the far side's, the background
  // where that is nothing, kNoTexel where another silhouette says.
  AlignedArray<int32_t> texel;
  // How far it moves from there with the inv_z above `low`.
  AlignedArray<float> texel_per_inv_z;
  // Last pixel of the near side of each silhouette; -1 if it goes on in front of the edge.
  AlignedArray<int32_t> near_texel;
  // Length by which the layer of a silhouette goes on in front of `low` from the edge, px. Behind
  // that, a ray as far back as `low` has met the far side. Negative: nothing is met.
  AlignedArray<float> behind_px;

  void reserve(uint32_t step_count);
};

// One of Steps.
struct Step {
  float edge_px = 0;
  float low_inv_z = 0;
  float high_inv_z = 0;
  int32_t texel = kNoTexel;
  float texel_per_inv_z = 0;
  int32_t near_texel = -1;
  float behind_px = -1;

  void addTo(Steps& steps) const;
};

// Texels on the far side of deep silhouettes, as they are and as the next one further in.
struct MixedTexels {
  uint32_t count = 0;
  AlignedArray<uint32_t> index;
  AlignedArray<uint32_t> own;
  AlignedArray<uint32_t> inner;

  void reserve(uint32_t texel_count);
  void add(uint32_t texel_index, uint32_t own_texel, uint32_t inner_texel);
};

// Which way rays travel along the row: those of an eye to the right of the source go left.
enum class Travel : uint8_t { kLeft, kRight };
template <typename T>
using ByTravel = std::array<T, 2>;

struct LayerSurfaces {
  Runs runs;
  ByTravel<Steps> bridges;      // links whose facets are apart: rays hit the edge
  ByTravel<Steps> silhouettes;  // rays pass behind
};

// One row of a source, at some height. Thread-safety: none.
struct SurfaceRow {
  uint32_t width_px = 0;
  uint32_t layer_count = 0;
  bool is_outside = false;  // above or below the image: no ray meets anything
  ByLayer<LayerSurfaces> layers;
  // Pixels of every surface from the left, and one more at both ends: packed codes.
  AlignedArray<uint32_t> texels;
  AlignedArray<uint8_t> texel_layer;
  uint32_t texel_count = 0;
  MixedTexels mixed;
  float clean = 0;                      // how far mixed texels have given way, 0..1
  AlignedArray<int32_t> nearest_texel;  // [column]: of layer 0, 256 times its index; -1: none
  ByLayer<const float*> inv_z{};        // of the samples, [column]
  StepRule deep;                        // steps that lead to another thing
  float left_inv_z = 0;                 // of layer 0 at the border of the image; kNoSurface
  float right_inv_z = 0;

  // Room for all that can be made of so many columns.
  void reserve(uint32_t columns, uint32_t layers_of_each);
  // Removes all surfaces.
  void clear();
  // Lets mixed texels give way to the next ones so far, 0..1.
  void cleanMixedTexels(float share);
  // The most that any layer has of runs or of steps of one kind.
  uint32_t pieceCountMax() const;
};

}  // namespace viewloom
