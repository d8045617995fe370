// SPDX-License-Identifier: Apache-2.0
#include "pictures/step_pictures.h"

#include <memory>

#include "gpu/sweep_under_test.h"
#include "gpu/walk_under_test.h"
#include "pictures/ray_pictures.h"
#include "pictures/scene_to_draw.h"
#include "pictures/structure_pictures.h"
#include "sweep/surface_row_builder.h"

namespace viewloom::pictures {
namespace {

// Tolerance of the display, output px.
constexpr double kTolerance_px = 0.25;

}  // namespace

std::vector<Picture> drawSteps(const Device& device) {
  const FramePtr frame = frameToDraw();
  const oracle::OutputView view = viewToDraw();
  WalkUnderTest walk(device);
  const std::unique_ptr<StructureSlot> slot = walk.build(*frame);
  const StructureImage structure = walk.readBack(*slot);
  const TracedView walked = walk.trace(*slot, {view}, kTolerance_px).front();
  SweepUnderTest sweep;
  sweep.prepare(frame);
  const TracedView swept = sweep.trace({view}, kTolerance_px).front();
  const double px_per_inv_z = view.position_m.x * view.pinhole.focal_px.x;
  SurfaceRowBuilder builder;
  const SurfaceRow& row = builder.build(sweep.source().rowSource(), kDrawnRow + 0.5,
                                        float(kTolerance_px / px_per_inv_z), float(px_per_inv_z));
  return {{"facets.svg", drawFacets(structure)}, {"links.svg", drawLinks(structure)},
          {"nodes.svg", drawNodes(structure)},   {"walk.svg", drawWalk(structure, walked)},
          {"sweep.svg", drawSweep(row, swept)},  {"fill.svg", drawFill(row, swept)}};
}

}  // namespace viewloom::pictures
