// SPDX-License-Identifier: Apache-2.0
#include "gpu/seen_mirrors.h"

#include <algorithm>
#include <cmath>

#include "support/srgb_transfer.h"
#include "support/truth/picture_frame.h"

namespace viewloom {

Camera finer(Camera camera, uint32_t times) {
  camera.intrinsics.focal_px *= double(times);
  camera.intrinsics.principal_px *= double(times);
  return camera;
}

SeenMirrors seenBy(const Camera& camera, SizePx view_px, const truth::Scene& scene,
                   const MirrorSource& source, const truth::MirrorOptions& options) {
  const truth::Instant instant(scene, 0);
  const SizePx source_px = {source.fineness * view_px.width, source.fineness * view_px.height};
  const truth::Picture picture =
      truth::takePicture(instant, finer(camera, source.fineness),
                         {.size_px = source_px, .layer_count = source.layer_count});
  return {camera, view_px, truth::frameOf(picture, source.layer_count),
          truth::takeMirrored(instant, camera, view_px, options)};
}

std::vector<double> apartCodes(OfflineRenderer& renderer, const SeenMirrors& seen,
                               const Frame& frame, const ReflectionSpec& reflection) {
  const RenderedAtlas atlas =
      renderInWorld(renderer, frame, {seen.camera}, seen.view_px, 1, reflection);
  std::vector<double> apart_codes;
  for (size_t i = 0; i < seen.truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double truth = srgbFrom(std::min(double{seen.truth[i][c]}, 1.0));
      const double shown = double{atlas.linear[4 * i + size_t(c)]};
      apart_codes.push_back(255 * std::abs(shown - truth));
    }
  }
  return apart_codes;
}

}  // namespace viewloom
