// SPDX-License-Identifier: Apache-2.0
// A source's structure and colour where the CPU reads them: in memory that it shares with the
// device.
#pragma once

#include <array>
#include <cstdint>

#include "frame/surface_steps.h"
#include "shared/structure_abi.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Valid as long as the slot holds the frame. Thread-safety: immutable.
struct HostStructure {
  SizePx size_px;
  uint32_t padded_width = 0;
  uint32_t padded_area = 0;
  uint32_t layer_count = 0;
  std::array<const abi::uvec2*, abi::kLayerCountMax> cells{};  // shared/structure_abi.h
  const uint32_t* color = nullptr;                             // layer after layer; sRGB, red first
  uint32_t color_stride = 0;                                   // texels from layer to layer
  float inv_z_max = 0;                                         // 1/m
  StepRule kappa;                                              // steps within a surface

  const abi::uvec2* level(uint32_t layer, uint32_t level) const {
    return cells[layer] + abi::levelOffset(level, padded_area);
  }
};

// Whether the CPU may take over what needs structures of this shape: the device is no other than
// the CPU, layers are small enough to lie one after the other, and colour is opaque sRGB of 8 bits,
// a texel for each sample of depth.
bool isInReach(const Device& device, const FrameShape& shape);

// View of a slot that is in reach and whose build is done.
HostStructure hostStructure(const StructureSlot& slot);

}  // namespace viewloom
