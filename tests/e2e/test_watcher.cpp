// SPDX-License-Identifier: Apache-2.0
#include "e2e/test_watcher.h"

#include <gtest/gtest.h>

#include "e2e/patience.h"

namespace viewloom {

v1::OpenDisplay smallQuilt(const std::string& stream) {
  v1::OpenDisplay open;
  open.set_stream(stream);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(2);
  quilt.set_rows(1);
  quilt.mutable_size()->set_width(16);
  quilt.mutable_size()->set_height(8);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  return open;
}

TestWatcher::TestWatcher(const std::shared_ptr<grpc::Channel>& channel)
    : stub_(v1::DisplayService::NewStub(channel)) {
  endAfterAMinute(context_);
  call_ = stub_->StreamAtlases(&context_);
}

TestWatcher::TestWatcher(const std::shared_ptr<grpc::Channel>& channel, const v1::OpenDisplay& open)
    : TestWatcher(channel) {
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = open;
  send(request);
}

TestWatcher::~TestWatcher() {
  if (finished_) return;
  cancel();
  finish();
}

std::optional<v1::StreamAtlasesResponse> TestWatcher::readMessage() {
  v1::StreamAtlasesResponse response;
  if (!call_->Read(&response)) return std::nullopt;
  return response;
}

std::optional<ReceivedAtlas> TestWatcher::readAtlas() {
  ReceivedAtlas atlas;
  v1::StreamAtlasesResponse response;
  while (call_->Read(&response)) {
    const bool begun = atlas.header.sequence() != 0;
    switch (response.message_case()) {
      case v1::StreamAtlasesResponse::kLayout:
        EXPECT_FALSE(begun) << "a layout within an atlas";
        atlas.layout = response.layout();
        break;
      case v1::StreamAtlasesResponse::kSkipped:
        EXPECT_FALSE(begun) << "a skip within an atlas";
        atlas.skipped_count += response.skipped().count();
        break;
      case v1::StreamAtlasesResponse::kHeader:
        EXPECT_FALSE(begun) << "a header within an atlas";
        atlas.header = response.header();
        break;
      case v1::StreamAtlasesResponse::kBand:
        checkBand(response.band(), atlas);
        break;
      case v1::StreamAtlasesResponse::kEnd:
        EXPECT_EQ(response.end().sequence(), atlas.header.sequence());
        EXPECT_EQ(atlas.color_bands.size(), atlas.header.band_count());
        atlas.end = response.end();
        return atlas;
      case v1::StreamAtlasesResponse::kAbandoned:
        EXPECT_EQ(response.abandoned().sequence(), atlas.header.sequence());
        atlas.header.Clear();
        atlas.color_bands.clear();
        ++atlas.abandoned_count;
        break;
      case v1::StreamAtlasesResponse::kClockReply:
        ADD_FAILURE() << "nobody asked what time it is";
        break;
      case v1::StreamAtlasesResponse::kHeartbeat:
        ADD_FAILURE() << "nobody asked for heartbeats";
        break;
      case v1::StreamAtlasesResponse::MESSAGE_NOT_SET:
        ADD_FAILURE() << "an empty message";
    }
  }
  return std::nullopt;
}

void TestWatcher::checkBand(const v1::Band& band, ReceivedAtlas& atlas) {
  EXPECT_EQ(band.sequence(), atlas.header.sequence());
  EXPECT_EQ(band.plane(), v1::ATLAS_PLANE_COLOR);
  std::string& bytes = atlas.color_bands[band.first_row()];
  EXPECT_EQ(band.offset_bytes(), bytes.size());
  EXPECT_LE(band.data().size(), size_t{1} << 20);
  bytes += band.data();
  ++atlas.piece_count;
}

grpc::Status TestWatcher::finish() {
  finished_ = true;
  v1::StreamAtlasesResponse response;
  while (call_->Read(&response)) {
  }
  return call_->Finish();
}

}  // namespace viewloom
