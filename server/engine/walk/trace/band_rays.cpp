// SPDX-License-Identifier: Apache-2.0
#include "trace/band_rays.h"

#include <algorithm>
#include <vector>

#include "shared/lens_abi.h"
#include "trace/band_params.h"
#include "trace/met_blocks.h"

namespace viewloom {
namespace {

// Middle rays for a lens that the host gathers. The answer for one that ends behind something would
// be as sharp as without a lens, so those pixels walk the rays of the first stage.
std::vector<BandRays> middleRays(const TraceJob& job, uint32_t wanted) {
  return {{.wanted = wanted, .lists_hidden = true},
          {.wanted = wanted & abi::kWantLinear, .count_of_hidden = job.layout->lens->walked_count}};
}

}  // namespace

bool gathersOnDevice(const TraceJob& job, const StructureSlot& structure) {
  return job.mayGather() && colorFormat(structure.shape().color_storage) != abi::kColorRgba16f;
}

std::vector<BandRays> raysOfPart(const TraceJob& job, const StructureSlot& first_structure,
                                 const TraceOutputs& outputs, const BandPart& part) {
  // Outputs other than colour belong to the ray through the middle of pixel and lens.
  const uint32_t wanted = wantedFlags(outputs);
  if (job.gathers_on_host) return middleRays(job, wanted);
  const bool gathers = gathersOnDevice(job, first_structure);
  const bool has_middle_apart = job.hasLens() && (wanted & ~abi::kWantLinear) != 0;
  std::vector<BandRays> rays;
  for (uint32_t sample = part.first_sample; sample < part.end_sample; ++sample) {
    if (sample == 0 && has_middle_apart) rays.push_back({.wanted = wanted & ~abi::kWantLinear});
    if (gathers) {
      rays.push_back({.sample = sample,
                      .through_lens = true,
                      .wanted = abi::kWantMet | abi::kWantSum,
                      .is_of_blocks = metRound(sample, job.sample_count).first > 0});
      continue;
    }
    rays.push_back({.sample = sample,
                    .through_lens = job.hasLens(),
                    .wanted = (sample == 0 && !has_middle_apart ? wanted : 0) |
                              (job.reflects() ? abi::kWantRecords : 0)});
  }
  if (part.paths == RayPaths::kAll) return rays;
  std::erase_if(rays, [&](const BandRays& some) {
    return some.through_lens != (part.paths == RayPaths::kThroughLens);
  });
  return rays;
}

abi::TracePush tracePush(const Walk& walk, const LayeredBuffer& color, BandRows rows) {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const uint32_t border = walk.job.outside_fill == OutsideFill::kBorder ? abi::kFillBorder : 0;
  const uint32_t first = walk.rays.sample == 0 ? abi::kFillFirst : 0;
  abi::TracePush push{.layers = {},
                      .color = {},
                      .source_size_px = packSize(structure.shape().depth_px),
                      .layer_count = structure.shape().layerCount(),
                      .atlas_width_px = layout.size_px.width,
                      .first_row = rows.first_row,
                      .tile_size_px = packSize(layout.tile_size_px),
                      .tile_grid = packSize({layout.columns, layout.rows}),
                      .padding_top_px = layout.padding_top_px,
                      .fill = redFirst(walk.job.background_rgb) | border | first,
                      .row_count = rows.row_count,
                      .first_block_row = metBlocks(layout, rows).first_row,
                      .band_row = 0,
                      .bounce = 0,
                      .sample_index = 0};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.color[i] = addressWords(color.address(i));
  }
  return push;
}

}  // namespace viewloom
