// SPDX-License-Identifier: Apache-2.0
// A tracked display of a whole pipeline, one frame and one head: each pose waits for its answer.
#pragma once

#include <memory>

#include "base/clock.h"
#include "e2e/collecting_subscriber.h"
#include "engine/make_engines.h"
#include "frame/frame.h"
#include "metrics/metrics.h"
#include "pipeline/pipeline.h"
#include "publish/broadcaster.h"

namespace viewloom::bench {

// Colour, depth and mask come RAW. Thread-safety: none.
class ServedHead {
 public:
  // Throws std::runtime_error when the display is not served.
  ServedHead(const Device& device, const FramePtr& frame, SizePx eye_px);

  // By the eyes that stand in until the first come.
  AtlasPtr atRest() const { return newest_; }
  AtlasPtr seenBy(EyePoses poses);

 private:
  AtlasPtr next();

  const SteadyClock clock_;
  Metrics metrics_;
  Broadcaster broadcaster_{{}};
  StreamDirectory directory_{clock_, 1};
  const Engines engines_;
  Pipeline pipeline_;
  const EyeTrackPtr eyes_ = std::make_shared<EyeTrack>();
  const std::shared_ptr<test::CollectingSubscriber> subscriber_ =
      std::make_shared<test::CollectingSubscriber>();
  std::unique_ptr<Broadcaster::Subscription> subscription_;
  size_t atlas_count_ = 0;
  AtlasPtr newest_;
};

}  // namespace viewloom::bench
