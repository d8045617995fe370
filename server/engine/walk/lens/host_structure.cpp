// SPDX-License-Identifier: Apache-2.0
#include "lens/host_structure.h"

#include <bit>

#include "base/check.h"
#include "structure/array_options.h"

namespace viewloom {

bool isInReach(const Device& device, const FrameShape& shape) {
  return device.info().is_software && writesColorInPlace(device, shape) && !shape.colorIsScaled() &&
         !mustDivide(device, shape);
}

HostStructure hostStructure(const StructureSlot& slot) {
  VIEWLOOM_CHECK(slot.colorIsInPlace() && !slot.structure().isDivided());
  const FrameShape& shape = slot.shape();
  const abi::MeasuredHead measured = slot.measuredHead();
  const SizePx padded_px = slot.layout().padded_px;
  HostStructure host{
      .size_px = shape.depth_px,
      .padded_width = padded_px.width,
      .padded_area = uint32_t(padded_px.area()),
      .layer_count = shape.layerCount(),
      .color = reinterpret_cast<const uint32_t*>(slot.color().mapped(0).data()),
      .color_stride = slot.colorStride(),
      .inv_z_max = std::bit_cast<float>(measured.inv_z_max_bits),
      .kappa = {
          .least = measured.kappa_abs, .share = measured.kappa_rel, .from = measured.inv_z_base}};
  for (uint32_t i = 0; i < host.layer_count; ++i) {
    host.cells[i] = reinterpret_cast<const abi::uvec2*>(slot.structure().mapped(i).data());
  }
  return host;
}

}  // namespace viewloom
