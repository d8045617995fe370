// SPDX-License-Identifier: Apache-2.0
#include "publish/eye_intake.h"

#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "display/atlas_layout.h"
#include "display/tracked_eyes.h"

namespace viewloom {
namespace {

std::optional<double> knownFocalDistance(const TrackedDisplay& display,
                                         const Broadcaster& broadcaster) {
  const double wanted_m = std::get<StereoSpec>(display.spec.kind).focal_distance_m;
  if (wanted_m > 0) return wanted_m;
  const std::shared_ptr<const AtlasLayout> layout = broadcaster.layout(display.id);
  if (layout == nullptr) return std::nullopt;
  return layout->focal_distance_m;
}

}  // namespace

absl::Status takeEyePoses(EyePoses poses, const TrackedDisplay& display,
                          const Broadcaster& broadcaster, EyeSink& sink) {
  if (const std::optional<double> focal_m = knownFocalDistance(display, broadcaster)) {
    VIEWLOOM_RETURN_IF_ERROR(validateInFront(poses, *focal_m));
  }
  display.track.put(std::move(poses));
  sink.serveEyes(display.id);
  return absl::OkStatus();
}

}  // namespace viewloom
