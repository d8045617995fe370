// SPDX-License-Identifier: Apache-2.0
#include "trace/px_runs.h"

#include <algorithm>
#include <iterator>

#include "shared/trace_abi.h"
#include "trace/band_parts.h"

namespace viewloom {
namespace {

// With fewer columns than lanes of a subgroup, neighbouring lanes take neighbouring runs of a view
// instead of neighbouring views.
constexpr uint32_t kColumnsForViewLanes = 5;
// A run traces a px more at both of its ends.
constexpr uint32_t kPixelsOnHardware = kRunPixelsMin;
// A software device pays more for an invocation than for a ray, and has few lanes to fill; as long
// as the px still share a bound where they start, which is found in a few nodes of 32 px. Lanes
// that are runs of one view have more in common if these are shorter.
constexpr uint32_t kPixelsOnSoftware[] = {60, 32, 16};
constexpr uint32_t kPixelsOnSoftwareInLanes = 16;
constexpr uint32_t kRunWidthMax_px = 384;  // of the source
static_assert(*std::begin(kPixelsOnSoftware) + 2 <= abi::kTraceGroupSize,
              "what is left of an unfinished run fits in a group");
static_assert(*std::begin(kPixelsOnSoftware) * abi::kTraceGroupSize <= kWalkColumns_px,
              "parts of rows have groups of their own");

}  // namespace

uint32_t pixelsOfRun(const DeviceInfo& device, const StructureSlot& structure,
                     const AtlasLayout& layout) {
  if (!device.is_software) return kPixelsOnHardware;
  if (!lanesAreViews(layout)) return kPixelsOnSoftwareInLanes;
  for (const uint32_t pixels : kPixelsOnSoftware) {
    const uint64_t run_width_px =
        uint64_t{pixels} * structure.shape().depth_px.width / layout.tile_size_px.width;
    if (run_width_px <= kRunWidthMax_px) return pixels;
  }
  return kRunPixelsMin;
}

bool lanesAreViews(const AtlasLayout& layout) {
  return layout.columns >= kColumnsForViewLanes;
}

}  // namespace viewloom
