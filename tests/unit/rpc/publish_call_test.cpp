// SPDX-License-Identifier: Apache-2.0
#include "rpc/publish_call.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "access/access_control.h"
#include "base/clock.h"
#include "fuzz/scripted_stream.h"
#include "messages/wire_message.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::publish_call_test {
namespace {

constexpr const char* kStream = "stream";
constexpr uint32_t kColor_bytes = 4;
constexpr uint32_t kDepth_bytes = 2;

void setOnePixel(v1::Plane& plane, v1::PlaneKind kind, v1::PlaneEncoding encoding,
                 uint32_t bytes_count) {
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(1);
  plane.mutable_size()->set_height(1);
  plane.set_bytes_count(bytes_count);
}

v1::PublishFramesRequest headerOf(uint64_t number) {
  v1::PublishFramesRequest request;
  v1::FrameHeader& header = *request.mutable_header();
  header.set_number(number);
  v1::Source& source = *header.add_sources();
  source.mutable_camera()->mutable_intrinsics()->set_focal_x_px(1);
  source.mutable_camera()->mutable_intrinsics()->set_focal_y_px(1);
  v1::Layer& layer = *source.add_layers();
  setOnePixel(*layer.add_planes(), v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, kColor_bytes);
  v1::Plane& depth = *layer.add_planes();
  setOnePixel(depth, v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_U16, kDepth_bytes);
  depth.mutable_depth()->set_meaning(v1::DEPTH_MEANING_DISPARITY);
  return request;
}

v1::PublishFramesRequest chunkOf(uint32_t plane_index, uint32_t bytes_count) {
  v1::PublishFramesRequest request;
  request.mutable_chunk()->set_plane_index(plane_index);
  request.mutable_chunk()->set_data(std::string(bytes_count, '\1'));
  return request;
}

// Wants no frame, so that each waits.
class ShutSink final : public FrameSink {
 public:
  void offerFrame(const FrameOrigin&, FramePtr, ReportFrame) override {}
  bool wantsFrame(const std::string&) override { return false; }
  void forgetStream(const std::string&) override {}
};

class PublishCallTest : public testing::Test {
 protected:
  PublishCallTest() {
    v1::PublishFramesRequest settings;
    settings.mutable_settings()->set_stream(kStream);
    call_->open();
    give(settings);
  }
  ~PublishCallTest() override {
    stream_.cancel();
    stream_.halfClose();
    for (stream_.settle(); !stream_.hasEnded(); stream_.settle()) stream_.finishWrite(false);
  }

  void give(const v1::PublishFramesRequest& request) {
    while (stream_.written()) stream_.finishWrite(true);
    stream_.give(bytesFromMessage(request));
  }
  void publish(uint64_t number) {
    give(headerOf(number));
    give(chunkOf(0, kColor_bytes));
    give(chunkOf(1, kDepth_bytes));
  }
  bool isLive() const { return directory_.list().at(0).live; }
  uint64_t receivedCount() const { return directory_.list().at(0).received_count; }

  ManualClock clock_;
  AccessControl access_{clock_};
  BytePool pool_{4};
  StreamDirectory directory_{clock_, 2};
  Broadcaster broadcaster_{{}};
  Metrics metrics_;
  ShutSink sink_;
  std::function<void()> on_replaced_ = [] {};
  FrameIntake intake_{sink_, clock_, pool_, {.on_replaced = [this] { on_replaced_(); }}};
  std::shared_ptr<PublishCall> call_ =
      std::make_shared<PublishCall>(IngestParts{.intake = intake_,
                                                .pool = pool_,
                                                .directory = directory_,
                                                .broadcaster = broadcaster_,
                                                .clock = clock_,
                                                .metrics = metrics_,
                                                .limits = {}},
                                    *access_.admit(kPublishFrames, "127.0.0.1", ""), "127.0.0.1");
  ScriptedStream stream_{call_};
};

TEST_F(PublishCallTest, readsOnWhereAFrameWaitsForLong) {
  publish(1);
  publish(2);
  EXPECT_EQ(receivedCount(), 1u) << "it is held back";
  clock_.advance(HeldBack::kMost_ns);
  call_->tick();
  publish(2);
  publish(3);
  EXPECT_EQ(receivedCount(), 3u);
}

// Were the name free before the frame waits, the stream could be forgotten between the two.
TEST_F(PublishCallTest, keepsItsNameUntilItsFrameWaits) {
  intake_.offer(kStream, {}, {}, [](const FrameReport&) {});
  bool was_live = false;
  on_replaced_ = [&] {
    call_->end(absl::CancelledError("planted"));
    was_live = isLive();
  };
  publish(1);
  EXPECT_TRUE(was_live);
  EXPECT_FALSE(isLive());
}

}  // namespace
}  // namespace viewloom::publish_call_test
