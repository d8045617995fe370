// SPDX-License-Identifier: Apache-2.0
#include "load/load_display.h"

#include <chrono>
#include <thread>

#include "base/clock.h"

namespace viewloom::load {
namespace {

constexpr std::chrono::seconds kSlowPause{1};
constexpr int64_t kEndTimeoutNs = 10'000'000'000;

void openQuilt(uint32_t columns, uint32_t rows, uint32_t side_px, v1::OpenDisplay& open) {
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(columns);
  quilt.set_rows(rows);
  quilt.mutable_size()->set_width(side_px);
  quilt.mutable_size()->set_height(side_px);
}

void openStereo(v1::OpenDisplay& open) {
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.mutable_eye_size()->set_width(320);
  stereo.mutable_eye_size()->set_height(240);
}

void openCameras(v1::OpenDisplay& open) {
  v1::CamerasDisplay& cameras = *open.mutable_display()->mutable_cameras();
  cameras.mutable_tile_size()->set_width(160);
  cameras.mutable_tile_size()->set_height(120);
  for (int i = 0; i < 4; ++i) {
    v1::Camera& camera = *cameras.add_cameras();
    camera.mutable_pose()->mutable_position()->set_x(0.02 * i);
    camera.mutable_pose()->mutable_position()->set_y(0.01 * (i % 2));
    camera.mutable_fov()->set_angle_left_rad(-0.4);
    camera.mutable_fov()->set_angle_right_rad(0.4);
    camera.mutable_fov()->set_angle_up_rad(0.3);
    camera.mutable_fov()->set_angle_down_rad(-0.3);
  }
}

std::string kindOf(const v1::OpenDisplay& open) {
  switch (open.display().kind_case()) {
    case v1::Display::kQuilt:
      return "quilt";
    case v1::Display::kStereo:
      return "stereo";
    default:
      return "cameras";
  }
}

}  // namespace

v1::OpenDisplay mixedDisplay(uint32_t index, const std::string& stream) {
  v1::OpenDisplay open;
  open.set_stream(stream);
  open.set_wait_for_stream(true);
  switch (index % 5) {
    case 0:
      openQuilt(4, 2, 512, open);
      break;
    case 1:
      openStereo(open);
      open.mutable_encoding()->set_chroma(v1::CHROMA_SUBSAMPLING_444);
      break;
    case 2:
      openCameras(open);
      open.mutable_encoding()->set_with_depth(true);
      open.mutable_encoding()->set_with_mask(true);
      break;
    case 3:
      openQuilt(4, 2, 512, open);  // shares the first one's trace and bytes
      break;
    case 4:
      openQuilt(5, 3, 400, open);
      open.mutable_encoding()->set_color(v1::BAND_ENCODING_ZSTD);
      break;
  }
  return open;
}

LoadDisplay::LoadDisplay(const std::shared_ptr<grpc::Channel>& channel, const v1::OpenDisplay& open,
                         bool is_slow)
    : book_{.stream = open.stream(), .kind = kindOf(open), .is_slow = is_slow},
      watcher_(channel, open, {.on_atlas = [this, is_slow](const Atlas& atlas) {
                 note(atlas);
                 if (is_slow) std::this_thread::sleep_for(kSlowPause);
               }}) {}

void LoadDisplay::note(const Atlas& atlas) {
  const int64_t now_ns = SteadyClock().nowNs();
  const v1::AtlasHeader& header = atlas.header;
  const v1::StageTimes& times = atlas.end.times();
  std::lock_guard lock(mutex_);
  book_.sequences_back += header.sequence() <= last_sequence_;
  book_.frames_back += header.frame_number() < last_frame_;
  last_sequence_ = header.sequence();
  last_frame_ = header.frame_number();
  book_.latency.add(now_ns - header.capture_time_ns());
  book_.stages["receive"].add(times.receive_ns());
  book_.stages["decode"].add(times.decode_ns());
  book_.stages["upload"].add(times.upload_ns());
  book_.stages["build"].add(times.build_ns());
  book_.stages["wait"].add(times.wait_ns());
  book_.stages["trace"].add(times.trace_ns());
  book_.stages["encode"].add(times.encode_ns());
  book_.stages["total"].add(times.total_ns());
}

DisplayBook LoadDisplay::finish() {
  watcher_.stop();
  const bool in_time = watcher_.waitEnded(kEndTimeoutNs);
  std::lock_guard lock(mutex_);
  book_.end = in_time ? *watcher_.ended() : absl::DeadlineExceededError("does not end");
  book_.counts = watcher_.counts();
  return book_;
}

}  // namespace viewloom::load
