// SPDX-License-Identifier: Apache-2.0
#include "bench/served_head.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/failed_pipeline.h"

namespace viewloom::bench {
namespace {

constexpr char kHeadStream[] = "head";

}  // namespace

ServedHead::ServedHead(const Device& device, const FramePtr& frame, SizePx eye_px)
    : engines_(makeEngines(device)),
      pipeline_({.engines = engines_,
                 .clock = clock_,
                 .metrics = metrics_,
                 .broadcaster = broadcaster_,
                 .directory = directory_,
                 .on_failure = endOfFailedPipeline},
                {}) {
  broadcaster_.onDemandChange(
      [this](const std::string& stream) { pipeline_.serveDisplays(stream); });
  const DisplaySpec spec =
      completeDisplaySpec({.kind = StereoSpec{.eye_size_px = eye_px, .is_tracked = true}}).value();
  const EncodingSpec encoding{.color = BandEncoding::kRaw,
                              .with_depth = true,
                              .with_mask = true,
                              .planes = BandEncoding::kRaw};
  auto subscription = broadcaster_.subscribe(kHeadStream, spec, encoding, subscriber_, eyes_);
  if (!subscription.ok()) throw std::runtime_error(std::string(subscription.status().message()));
  subscription_ = *std::move(subscription);
  pipeline_.offerFrame({kHeadStream, 1}, frame, [](const FrameReport&) {});
  newest_ = next();
}

AtlasPtr ServedHead::seenBy(EyePoses poses) {
  poses.received_ns = clock_.nowNs();
  eyes_->put(std::move(poses));
  pipeline_.serveEyes(subscription_->displayId());
  return newest_ = next();
}

AtlasPtr ServedHead::next() {
  const std::vector<AtlasPtr> atlases = subscriber_->waitForAtlases(++atlas_count_);
  if (atlases.size() < atlas_count_) throw std::runtime_error("eyes were not answered");
  return atlases.back();
}

}  // namespace viewloom::bench
