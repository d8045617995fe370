// SPDX-License-Identifier: Apache-2.0
// A whole server in process, on a validated device and on ports of its choice.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/clock.h"
#include "e2e/atlas_viewer.h"
#include "e2e/wire_frames.h"
#include "engine_room.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "service.h"
#include "support/test_device.h"

namespace viewloom::test {

inline constexpr std::chrono::seconds kGiveUpAfter{120};  // reached only by a test that fails

// Fails on any validation message of warning or above that the server caused.
class ServiceFixture : public DeviceNeededTest {
 protected:
  void SetUp() override {
    DeviceNeededTest::SetUp();
    if (IsSkipped()) return;
    Config config;
    config.validation = true;
    config.grpc.address = "127.0.0.1:0";
    config.http.address = "127.0.0.1:0";
    // The tests of VIEWLOOM_HARDWARE_VIDEO name another encoder.
    if (const char* const encoder = std::getenv("VIEWLOOM_PIPELINE_VIDEO_ENCODER")) {
      config.pipeline.video_encoder = encoder;
    }
    service_.emplace(config, clock_,
                     [](const std::exception& error) { ADD_FAILURE() << error.what(); });
  }

  void TearDown() override {
    if (IsSkipped()) return;
    EXPECT_EQ(service_->engineRoom().deviceMessageCount(), 0u);
  }

  // A frame of "scene", by a publisher that has left.
  void publishOnce(uint32_t layer_count) {
    publishOnce(syntheticWireFrame({160, 90}, layer_count, 0));
  }
  void publishOnce(WireFrame frame) {
    Publisher publisher(makeChannel(service_->grpcAddress()),
                        {.stream = "scene", .session_id = "", .backoff = {}}, {});
    publisher.offer(std::move(frame));
    const absl::Status end = publisher.finish(std::chrono::nanoseconds(kGiveUpAfter).count());
    ASSERT_TRUE(end.ok()) << end;
  }

  // The first atlas of a display.
  Atlas atlasOf(const v1::OpenDisplay& open) {
    return AtlasViewer(service_->grpcAddress(), open).waitFor([](const Atlas&) { return true; });
  }

  SteadyClock clock_;
  std::optional<Service> service_;
};

}  // namespace viewloom::test
