// SPDX-License-Identifier: Apache-2.0
#include "e2e/test_publisher.h"

#include <utility>

#include "e2e/patience.h"

namespace viewloom {
namespace {

constexpr uint32_t kSidePx = 4;

v1::Plane smallPlane(v1::PlaneKind kind, v1::PlaneEncoding encoding, uint32_t pixel_bytes) {
  v1::Plane plane;
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(kSidePx);
  plane.mutable_size()->set_height(kSidePx);
  plane.set_bytes_count(kSidePx * kSidePx * pixel_bytes);
  return plane;
}

}  // namespace

v1::FrameHeader smallHeader(uint64_t number) {
  v1::FrameHeader header;
  header.set_number(number);
  header.set_capture_time_ns(static_cast<int64_t>(number) * 1000);
  v1::Source& source = *header.add_sources();
  v1::Fov& fov = *source.mutable_camera()->mutable_fov();
  fov.set_angle_left_rad(-0.5);
  fov.set_angle_right_rad(0.5);
  fov.set_angle_up_rad(0.4);
  fov.set_angle_down_rad(-0.4);
  v1::Layer& layer = *source.add_layers();
  *layer.add_planes() = smallPlane(v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGB8, 3);
  *layer.add_planes() = smallPlane(v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, 4);
  layer.mutable_planes(1)->mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  return header;
}

v1::FrameChunk chunkOf(uint32_t plane_index, uint64_t offset_bytes, std::string data) {
  v1::FrameChunk chunk;
  chunk.set_plane_index(plane_index);
  chunk.set_offset_bytes(offset_bytes);
  chunk.set_data(std::move(data));
  return chunk;
}

TestPublisher::TestPublisher(const std::shared_ptr<grpc::Channel>& channel)
    : stub_(v1::IngestService::NewStub(channel)) {
  endAfterAMinute(context_);
  call_ = stub_->PublishFrames(&context_);
}

TestPublisher::TestPublisher(const std::shared_ptr<grpc::Channel>& channel,
                             const std::string& stream, const std::string& session_id)
    : TestPublisher(channel) {
  sendSettings(stream, session_id);
  read();
}

TestPublisher::~TestPublisher() {
  if (finished_) return;
  cancel();
  finish();
}

bool TestPublisher::sendSettings(const std::string& stream, const std::string& session_id) {
  v1::PublishFramesRequest request;
  request.mutable_settings()->set_stream(stream);
  request.mutable_settings()->set_session_id(session_id);
  return send(request);
}

bool TestPublisher::sendHeader(const v1::FrameHeader& header) {
  v1::PublishFramesRequest request;
  *request.mutable_header() = header;
  return send(request);
}

bool TestPublisher::sendChunk(const v1::FrameChunk& chunk) {
  v1::PublishFramesRequest request;
  *request.mutable_chunk() = chunk;
  return send(request);
}

bool TestPublisher::sendFrame(uint64_t number) {
  const v1::FrameHeader header = smallHeader(number);
  const auto& planes = header.sources(0).layers(0).planes();
  return sendHeader(header) &&
         sendChunk(chunkOf(0, 0, std::string(planes[0].bytes_count(), 'c'))) &&
         sendChunk(chunkOf(1, 0, std::string(planes[1].bytes_count(), '@')));
}

std::optional<v1::PublishFramesResponse> TestPublisher::read() {
  v1::PublishFramesResponse response;
  if (!call_->Read(&response)) return std::nullopt;
  return response;
}

std::optional<v1::FrameReport> TestPublisher::readReport() {
  while (const auto response = read()) {
    if (response->has_report()) return response->report();
  }
  return std::nullopt;
}

std::optional<v1::Wanted> TestPublisher::readWanted() {
  while (const auto response = read()) {
    if (response->has_wanted()) return response->wanted();
  }
  return std::nullopt;
}

grpc::Status TestPublisher::finish() {
  finished_ = true;
  while (read().has_value()) {
  }
  return call_->Finish();
}

}  // namespace viewloom
