// SPDX-License-Identifier: Apache-2.0
// Displays with an output rate of a whole server, as clients decode them.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "e2e/atlas_viewer.h"
#include "e2e/wire_frames.h"
#include "engine_room.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "service.h"
#include "support/test_device.h"

namespace viewloom::test::service_ticks_test {
namespace {

constexpr int64_t kInterval_ns = 100'000'000;
constexpr int64_t kBridge_ns = 250'000'000;
constexpr double kStep_m = 0.05;  // along x, from frame to frame

Config anyPorts() {
  Config config;
  config.validation = true;
  config.grpc.address = "127.0.0.1:0";
  config.http.enabled = false;
  return config;
}

v1::OpenDisplay openPair() {
  v1::OpenDisplay open;
  open.set_stream("scene");
  open.set_wait_for_stream(true);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.mutable_eye_size()->set_width(96);
  stereo.mutable_eye_size()->set_height(64);
  return open;
}

std::vector<uint8_t> colorOf(const Atlas& atlas) {
  auto picture = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  EXPECT_TRUE(picture.ok()) << picture.status();
  return std::move(picture->samples);
}

class ServiceTicksTest : public DeviceNeededTest {
 protected:
  void SetUp() override {
    DeviceNeededTest::SetUp();
    if (IsSkipped()) return;
    service_.emplace(anyPorts(), clock_,
                     [](const std::exception& error) { ADD_FAILURE() << error.what(); });
    publisher_.emplace(makeChannel(service_->grpcAddress()),
                       PublisherOptions{.stream = "scene", .session_id = "", .backoff = {}},
                       PublisherCallbacks{});
  }

  void TearDown() override {
    publisher_.reset();
    if (IsSkipped()) return;
    EXPECT_EQ(service_->engineRoom().deviceMessageCount(), 0u);
  }

  // The camera goes on by a step with each.
  void publish(int64_t index) {
    WireFrame frame = syntheticWireFrame({160, 90}, 2, 0.1 * double(index));
    frame.header.set_capture_time_ns(index * kInterval_ns);
    frame.header.mutable_sources(0)->mutable_camera()->mutable_pose()->mutable_position()->set_x(
        double(index) * kStep_m);
    publisher_->offer(frame);
  }

  std::unique_ptr<AtlasViewer> view(const v1::OpenDisplay& open) {
    return std::make_unique<AtlasViewer>(service_->grpcAddress(), open);
  }

  SteadyClock clock_;
  std::optional<Service> service_;
  std::optional<Publisher> publisher_;
};

TEST_F(ServiceTicksTest, showsWhatADisplayInThePredictedPlaceSees) {
  v1::OpenDisplay open = openPair();
  open.mutable_display()->mutable_effects()->mutable_temporal()->set_output_rate_hz(60);
  const auto ticking = view(open);
  publish(1);
  ticking->waitForFrame(1);
  publish(2);
  // No other frame comes: what it is held at is carried on by what its speed falls along.
  const Atlas held =
      ticking->waitFor([](const Atlas& atlas) { return atlas.header.timing() == v1::TIMING_HELD; });
  EXPECT_EQ(held.header.frame_number(), 2u);
  EXPECT_EQ(held.header.capture_time_ns(), 2 * kInterval_ns);
  EXPECT_EQ(held.header.shown_time_ns(), 2 * kInterval_ns + kBridge_ns);
  EXPECT_EQ(held.header.source_camera().pose().position().x(), 2 * kStep_m);
  const double carried = 1 + 0.5 * double(kBridge_ns - kInterval_ns) / double(kInterval_ns);
  EXPECT_NEAR(held.header.display_pose().position().x(), (2 + carried) * kStep_m, 1e-9);
  v1::OpenDisplay fixed = openPair();
  *fixed.mutable_display()->mutable_world_pose() = held.header.display_pose();
  const Atlas there = view(fixed)->waitFor([](const Atlas&) { return true; });
  EXPECT_EQ(there.header.timing(), v1::TIMING_CAPTURED);
  EXPECT_EQ(there.header.shown_time_ns(), 2 * kInterval_ns);
  EXPECT_EQ(colorOf(held), colorOf(there));
}

}  // namespace
}  // namespace viewloom::test::service_ticks_test
