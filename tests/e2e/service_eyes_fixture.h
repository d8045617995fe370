// SPDX-License-Identifier: Apache-2.0
// A whole server with a publisher, and displays seen by eyes that tests move.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "e2e/atlas_viewer.h"
#include "e2e/service_fixture.h"

namespace viewloom::test {

// The rectangle that a display of these frames: 1.5 m x 1 m, 4 m in front of it.
inline constexpr double kHalfWidth_m = 0.75;
inline constexpr double kHalfHeight_m = 0.5;
inline constexpr double kDistance_m = 4;
inline constexpr uint32_t kEyeWidth_px = 96;
inline constexpr uint32_t kEyeHeight_px = 64;

inline v1::OpenDisplay openEyes() {
  v1::OpenDisplay open;
  open.set_stream("scene");
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.mutable_eye_size()->set_width(kEyeWidth_px);
  stereo.mutable_eye_size()->set_height(kEyeHeight_px);
  stereo.set_focal_distance_m(kDistance_m);
  stereo.set_fov_y_rad(2 * std::atan(kHalfHeight_m / kDistance_m));
  return open;
}

inline v1::OpenDisplay openTracked() {
  v1::OpenDisplay open = openEyes();
  open.mutable_display()->mutable_stereo()->set_tracked(true);
  return open;
}

struct Place {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
};

inline void place(v1::Camera& camera, const Place& at) {
  v1::Vector3& position = *camera.mutable_pose()->mutable_position();
  position.set_x(at.x_m);
  position.set_y(at.y_m);
  position.set_z(at.z_m);
}

// Eye poses measured at time_ns, for a picture shown 11 ms later.
inline v1::EyePoses posesAt(int64_t time_ns, const Place& left, const Place& right) {
  v1::EyePoses poses;
  poses.set_time_ns(time_ns);
  poses.set_predicted_display_time_ns(time_ns + 11'000'000);
  place(*poses.add_eyes(), left);
  place(*poses.add_eyes(), right);
  return poses;
}

// Adds an eye at `at` that sees through the screen's rectangle, by Kooima's formula. Its frustum
// is given as angles at the eye's distance from the screen.
inline void addWindowCamera(v1::StereoDisplay& stereo, const Place& at) {
  v1::Camera& eye = *stereo.add_eyes();
  place(eye, at);
  const double distance_m = kDistance_m + at.z_m;
  v1::Fov& fov = *eye.mutable_fov();
  fov.set_angle_left_rad(std::atan((-kHalfWidth_m - at.x_m) / distance_m));
  fov.set_angle_right_rad(std::atan((kHalfWidth_m - at.x_m) / distance_m));
  fov.set_angle_down_rad(std::atan((-kHalfHeight_m - at.y_m) / distance_m));
  fov.set_angle_up_rad(std::atan((kHalfHeight_m - at.y_m) / distance_m));
}

inline std::vector<uint8_t> colorOf(const Atlas& atlas) {
  auto picture = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  EXPECT_TRUE(picture.ok()) << picture.status();
  return std::move(picture->samples);
}

// `Wanted` messages to the publisher. Thread-safety: any thread may call any method.
class WantedLog {
 public:
  void note(const v1::Wanted& wanted) {
    std::lock_guard lock(mutex_);
    newest_ = wanted;
    came_.notify_all();
  }

  // Waits until the newest message fulfils `holds`, and returns it.
  v1::Wanted waitFor(const std::function<bool(const v1::Wanted&)>& holds) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(came_.wait_for(lock, kGiveUpAfter, [&] { return holds(newest_); }));
    return newest_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  v1::Wanted newest_;
};

class ServiceEyesTest : public ServiceFixture {
 protected:
  void SetUp() override {
    ServiceFixture::SetUp();
    if (IsSkipped()) return;
    publisher_.emplace(
        makeChannel(service_->grpcAddress()),
        PublisherOptions{.stream = "scene", .session_id = "", .backoff = {}},
        PublisherCallbacks{.on_accepted = {},
                           .on_report = {},
                           .on_wanted = [this](const v1::Wanted& told) { wanted_.note(told); },
                           .on_connection = {},
                           .on_sent = {}});
  }

  void TearDown() override {
    publisher_.reset();
    ServiceFixture::TearDown();
  }

  void publish() { publisher_->offer(syntheticWireFrame({160, 90}, 2, 0.1 * ++frame_count_)); }

  std::unique_ptr<AtlasViewer> view(const v1::OpenDisplay& open) {
    v1::OpenDisplay waiting = open;
    waiting.set_wait_for_stream(true);
    return std::make_unique<AtlasViewer>(service_->grpcAddress(), waiting);
  }

  // Atlas of the resident frame on a fixed display with these eyes.
  Atlas fixedAt(const Place& left, const Place& right) {
    v1::OpenDisplay open = openEyes();
    addWindowCamera(*open.mutable_display()->mutable_stereo(), left);
    addWindowCamera(*open.mutable_display()->mutable_stereo(), right);
    return view(open)->waitFor([](const Atlas&) { return true; });
  }

  double tracedCount() const {
    return service_->metrics().atlases_traced[TraceMethod::kWalk].value() +
           service_->metrics().atlases_traced[TraceMethod::kSweep].value();
  }

  WantedLog wanted_;
  std::optional<Publisher> publisher_;
  int frame_count_ = 0;
};

}  // namespace viewloom::test
