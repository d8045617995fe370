// SPDX-License-Identifier: Apache-2.0
// The mean light of rays of a block of px through a lens, of what they meet of a few sheets, with
// the vectors of the CPU it runs on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lens/host_structure.h"
#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

namespace viewloom {

inline constexpr uint32_t kBlockArea_px = abi::kMetBlockSide_px * abi::kMetBlockSide_px;

// A ray of each px of a block, row by row: where it goes through a lens of radius 1, to the right
// and up, and where beside the middle of its px.
struct LensPoint {
  alignas(64) std::array<float, kBlockArea_px> x;
  alignas(64) std::array<float, kBlockArea_px> y;
  float beside_x_px = 0;
  float beside_y_px = 0;
};

// Rays of a block, and the sheets they may meet.
struct GatheredRays {
  const HostStructure& structure;
  const abi::ViewParams& view;
  float first_x_px = 0;  // of the block, in its tile
  float first_y_px = 0;
  std::span<const LensPoint> points;
  std::span<const abi::MetSheet> sheets;  // no more than 32
  bool may_leave = true;                  // some may meet a sheet beyond the image
  bool fills_border = false;  // beyond the image its border goes on; else there is the background
  uint32_t background = 0;    // red in the low byte
};

// By px, row by row.
struct alignas(64) OfBlock : std::array<float, kBlockArea_px> {};

// The light of rays, and how many they are.
struct BlockLight {
  OfBlock red, green, blue, count;
};

// Codes of sRGB, 0..255, before they are rounded.
struct BlockCodes {
  OfBlock red, green, blue;
};

// Adds rays that all meet the first sheet and nothing before it. Who does beyond the image sees its
// border, or is left out if that does not go on.
void gatherOnSheet(const GatheredRays& rays, BlockLight& light);

// A ray that met no sheet.
struct OpenRay {
  uint32_t px = 0;     // of the block
  uint32_t point = 0;  // of the points
};

// Sheets that rays met.
struct MetSheets {
  uint32_t sheets = 0;   // bit i: sheet i
  bool is_all = true;    // every ray met one, or the image's border if that goes on
  OfBlock open_count{};  // rays that met none, and added nothing
};

// Adds rays that meet the nearest facet of those that are within the reach of a sheet where they
// meet that; of a ray that meets a sheet beyond the image, what is there. `open`, if it is given,
// gets those that meet neither.
MetSheets gatherOnSheets(const GatheredRays& rays, BlockLight& light, std::vector<OpenRay>* open);

// The mean of all rays.
void meanOf(const BlockLight& light, BlockCodes& codes);

}  // namespace viewloom
