// SPDX-License-Identifier: Apache-2.0
// Displays with an output rate of their own before a pipeline, by a clock that the test turns.
#pragma once

#include <chrono>
#include <thread>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test {

inline constexpr int64_t kMs_ns = 1'000'000;
inline constexpr int64_t kFrame_ns = 100 * kMs_ns;
inline constexpr int64_t kTick_ns = 20 * kMs_ns;
inline constexpr int64_t kBridge_ns = 250 * kMs_ns;
// Time of the publisher's clock when the server's clock is 0.
inline constexpr int64_t kStart_ns = 1'000'000 * kMs_ns;

inline DisplaySpec ticking(DisplaySpec spec = smallQuilt({64, 40})) {
  spec.temporal = TemporalSpec{.output_rate_hz = 50};
  return *completeDisplaySpec(std::move(spec));
}

// After so many ticks without an atlas, no more will come: a frame is bridged for fewer ticks.
inline constexpr int kTicksMax = 40;

class TicksFixture : public PipelineFixture {
 protected:
  // The next atlas of the display, at the first tick that brings one: at some the last atlas may
  // not be off the loops yet, or the frame still on its way through them.
  static AtlasPtr next(Server& server, const Viewer& viewer) {
    const uint64_t display_id = viewer.subscription->displayId();
    const uint64_t count = server.broadcaster.atlasCount(display_id);
    const auto isStill = [&] { return server.broadcaster.atlasCount(display_id) == count; };
    for (int tick = 0; tick < kTicksMax && isStill(); ++tick) {
      const double skipped_count = server.metrics.output_ticks_skipped.value();
      server.clock.advance(kTick_ns);
      // A tick that is skipped says that an atlas is on its way: no other is asked for meanwhile.
      const auto patience = [&] {
        return server.metrics.output_ticks_skipped.value() > skipped_count ? 20000 : 300;
      };
      for (int nap = 0; nap < patience() && isStill(); ++nap) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    return server.broadcaster.newest(display_id);
  }
};

}  // namespace viewloom::test
