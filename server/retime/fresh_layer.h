// SPDX-License-Identifier: Apache-2.0
// Writes the planes of a layer of a source whose surfaces have moved.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "retime/blend_kernels.h"
#include "retime/edge_light.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

// Surfaces that come into view and that no layer holds take the farther side of their row.
enum class Guesses : uint8_t {
  kStand,    // as far as that is
  kGiveWay,  // behind it, so that whoever knows better what is there is seen before it
};

// Written planes of a layer, [px] each.
struct FreshPlanes {
  float* inv_z = nullptr;
  uint8_t* color = nullptr;
  uint8_t* surface = nullptr;   // nullptr: nothing mirrors
  uint32_t* samples = nullptr;  // that most of each px is, kNoSample where nothing is; or nullptr
};

// Fresh columns of a row.
struct FreshRow {
  void reserve(uint32_t width);

  BlendedRow blends;
  AlignedArray<uint32_t> marked;  // as blendTexels() has it
};

size_t texelBytes(PlaneEncoding encoding);

// Thread-safety: rows may be written by several threads at a time.
class FreshLayer {
 public:
  FreshLayer(const MovedSurfaces& surfaces, const EdgeLight& edges, uint32_t layer,
             const FreshPlanes& to);

  // Writes a row: as the frame has it, and `fresh` at its fresh columns.
  void writeRow(uint32_t y, FreshRow& fresh) const;
  // Fills pixels at which the frame has a surface and nothing is any more.
  void fillRow(uint32_t y, Guesses guesses) const;

 private:
  void writeStanding(uint32_t y, const Columns& columns) const;
  void writeColors(uint32_t px, uint32_t count, FreshRow& fresh) const;
  void blendBytes(uint32_t px, uint32_t count, FreshRow& fresh) const;
  void blendPx(uint32_t px, uint32_t i, const BlendedRow& fresh) const;
  void writeSurfaces(uint32_t px, uint32_t count, const BlendedRow& fresh) const;
  void copyPx(uint32_t from, uint32_t to) const;

  const MovedSurfaces& surfaces_;
  const EdgeLight& edges_;
  const uint32_t layer_;
  const FreshPlanes to_;
  const std::vector<LayerPlanes>& from_;
  const PlaneEncoding encoding_;  // of colour, on all layers
};

}  // namespace viewloom
