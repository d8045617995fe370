// SPDX-License-Identifier: Apache-2.0
#include "fidelity/own_views.h"

#include "fidelity/value_or_throw.h"
#include "offline/manifest_frame.h"

namespace viewloom::fidelity {
namespace {

// px of a view. Far below what shows, so that what is scored is the method: with 0.25, which
// displays get for speed, the beach ball has 0.03 / 0.07 dB less, antinous 0.01.
constexpr double kTolerance_px = 0.03;

}  // namespace

std::vector<RenderedView> renderViews(OfflineRenderer& renderer, const test::DataSet& set,
                                      const std::vector<test::TrueView>& views,
                                      ScoreTransfer transfer, const CoarseDepth* coarse) {
  Frame frame = *valueOrThrow(loadManifestFrame(frameManifest(set), {})).frame;
  if (coarse != nullptr) {
    PlaneFormat& format = frame.format.sources[0].layers[0].depth;
    format.encoding = coarse->encoding;
    format.depth = coarse->format;
    frame.sources[0][0].depth = coarse->samples;
  }
  renderer.build(frame);

  CamerasSpec cameras = {.tile_size_px = set.size_px, .columns = 1};
  for (const test::TrueView& view : views) {
    const Camera camera = cameraOf(set, view);
    cameras.cameras.push_back({camera.pose, camera.intrinsics});
  }
  std::vector<RenderedView> rendered;
  const DisplaySpec spec =
      valueOrThrow(completeDisplaySpec({.kind = cameras, .tolerance_px = kTolerance_px}));
  const RenderedAtlas atlas = valueOrThrow(
      renderer.render(spec, {.mask = true, .linear = true}, [](uint32_t, uint32_t) {}));
  for (uint32_t view = 0; view < views.size(); ++view) {
    rendered.push_back(cutView(atlas, view, transfer));
  }
  return rendered;
}

}  // namespace viewloom::fidelity
