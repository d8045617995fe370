// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>

#include <google/protobuf/message_lite.h>

#include "fuzz/seeds.h"
#include "recording/recording_format.h"
#include "viewloom/v1/display_service.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

using Message = google::protobuf::MessageLite;

// Steps of calls_target.cpp.
constexpr uint8_t kSend = 0, kWritten = 1, kHalfClose = 2, kCancel = 3, kTick = 5, kPublish = 6,
                  kWatch = 7, kHold = 8, kLetGo = 9;

v1::Plane& addPlane(v1::Layer& layer, v1::PlaneKind kind, v1::PlaneEncoding encoding,
                    uint32_t pixel_bytes) {
  v1::Plane& plane = *layer.add_planes();
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(3);
  plane.mutable_size()->set_height(2);
  plane.set_bytes_count(uint64_t{6} * pixel_bytes);
  return plane;
}

v1::FrameHeader flatHeader(uint64_t number) {
  v1::FrameHeader header;
  header.set_number(number);
  v1::Source& source = *header.add_sources();
  v1::Fov& fov = *source.mutable_camera()->mutable_fov();
  fov.set_angle_left_rad(-0.5);
  fov.set_angle_right_rad(0.5);
  fov.set_angle_up_rad(0.4);
  fov.set_angle_down_rad(-0.4);
  v1::Layer& layer = *source.add_layers();
  addPlane(layer, v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, 4);
  addPlane(layer, v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_U16, 2)
      .mutable_depth()
      ->set_meaning(v1::DEPTH_MEANING_DISPARITY);
  return header;
}

v1::FrameHeader mirrorHeader() {
  v1::FrameHeader header = flatHeader(2);
  v1::Layer& layer = *header.mutable_sources(0)->mutable_layers(0);
  addPlane(layer, v1::PLANE_KIND_MOTION, v1::PLANE_ENCODING_XYZ16F, 6);
  addPlane(layer, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_OCT16, 4);
  addPlane(layer, v1::PLANE_KIND_ROUGHNESS, v1::PLANE_ENCODING_R8, 1);
  addPlane(layer, v1::PLANE_KIND_SPECULAR, v1::PLANE_ENCODING_RGB8, 3);
  return header;
}

v1::PublishFramesRequest chunkOf(uint32_t plane, uint64_t offset, const std::string& data) {
  v1::PublishFramesRequest request;
  request.mutable_chunk()->set_plane_index(plane);
  request.mutable_chunk()->set_offset_bytes(offset);
  request.mutable_chunk()->set_data(data);
  return request;
}

std::vector<v1::PublishFramesRequest> publishedFrame(uint64_t number) {
  v1::PublishFramesRequest header;
  *header.mutable_header() = flatHeader(number);
  return {header, chunkOf(0, 0, std::string(20, 'c')), chunkOf(0, 20, std::string(4, 'd')),
          chunkOf(1, 0, std::string(12, 'z'))};
}

v1::OpenDisplay openQuilt() {
  v1::OpenDisplay open;
  open.set_stream("s");
  open.set_wait_for_stream(true);
  open.set_wants_heartbeats(true);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(2);
  quilt.set_rows(2);
  quilt.mutable_size()->set_width(16);
  quilt.mutable_size()->set_height(12);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  return open;
}

v1::OpenDisplay openTrackedEyes() {
  v1::OpenDisplay open = openQuilt();
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.set_tracked(true);
  stereo.mutable_eye_size()->set_width(8);
  stereo.mutable_eye_size()->set_height(6);
  return open;
}

v1::EyePoses twoEyes() {
  v1::EyePoses poses;
  poses.set_time_ns(8);
  for (const double x_m : {-0.03, 0.03}) {
    v1::Camera& eye = *poses.add_eyes();
    eye.mutable_pose()->mutable_position()->set_x(x_m);
    eye.mutable_pose()->mutable_orientation()->set_w(1);
  }
  return poses;
}

std::vector<v1::StreamAtlasesResponse> atlasMessages() {
  std::vector<v1::StreamAtlasesResponse> messages(4);
  v1::AtlasLayout& layout = *messages[0].mutable_layout();
  layout.mutable_size()->set_width(4);
  layout.mutable_size()->set_height(2);
  layout.mutable_tile_size()->set_width(2);
  layout.mutable_tile_size()->set_height(2);
  layout.set_columns(2);
  layout.set_rows(1);
  layout.set_view_count(2);
  layout.set_image_count(1);
  layout.set_suffix("_qs2x1a1");
  messages[1].mutable_header()->set_sequence(1);
  messages[1].mutable_header()->set_band_count(1);
  v1::Band& band = *messages[2].mutable_band();
  band.set_sequence(1);
  band.set_plane(v1::ATLAS_PLANE_COLOR);
  band.set_row_count(2);
  band.set_encoding(v1::BAND_ENCODING_RAW);
  band.set_data(std::string(24, 'p'));
  band.set_last_piece(true);
  messages[3].mutable_end()->set_sequence(1);
  return messages;
}

std::vector<uint8_t> bytesOf(const Message& message) {
  return SeedWriter().text(message.SerializeAsString()).done();
}

// Number of `byte_count` bytes, the lowest first.
std::string littleEndian(uint64_t number, size_t byte_count) {
  std::string bytes;
  for (size_t i = 0; i < byte_count; ++i) bytes += static_cast<char>(number >> 8 * i);
  return bytes;
}

template <typename SomeMessage>
std::vector<uint8_t> recordingOf(RecordingKind kind, const std::vector<SomeMessage>& messages) {
  SeedWriter file;
  file.text({kRecordingMagic.begin(), kRecordingMagic.end()});
  file.text(littleEndian(kRecordingVersion, 4) + littleEndian(static_cast<uint32_t>(kind), 4));
  for (const SomeMessage& message : messages) {
    const std::string bytes = message.SerializeAsString();
    file.text(littleEndian(5, 8) + littleEndian(bytes.size(), 4) + bytes);
  }
  return file.text(littleEndian(5, 8) + littleEndian(0, 4)).done();
}

// A step of the call with this number that sends a message.
void send(SeedWriter& script, uint8_t call, const Message& message) {
  script.bytes({kSend, call}).counted(message.SerializeAsString());
}

void beginPublishing(SeedWriter& script, uint8_t call) {
  v1::PublishFramesRequest settings;
  settings.mutable_settings()->set_stream("s");
  settings.mutable_settings()->set_session_id("id");
  settings.mutable_settings()->set_sends_heartbeats(true);
  script.bytes({kPublish});
  send(script, call, settings);
}

// One publishes two frames, another watches them from their first on.
std::vector<uint8_t> watchedStream() {
  SeedWriter script;
  beginPublishing(script, 0);
  for (const auto& message : publishedFrame(1)) send(script, 0, message);
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openQuilt();
  script.bytes({kWatch});
  send(script, 1, request);
  for (const auto& message : publishedFrame(2)) send(script, 0, message);
  for (int i = 0; i < 8; ++i) script.bytes({kWritten, 0, kWritten, 1});
  request.mutable_change()->mutable_encoding()->set_with_depth(true);
  send(script, 1, request);
  return script.bytes({kTick, 0, kTick, 1, kHalfClose, 0, kWritten, 0, kHalfClose, 1}).done();
}

// Eyes come, and a second publisher takes the stream over.
std::vector<uint8_t> trackedStream() {
  SeedWriter script;
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openTrackedEyes();
  script.bytes({kWatch});
  send(script, 0, request);
  *request.mutable_eye_poses() = twoEyes();
  send(script, 0, request);
  beginPublishing(script, 1);
  beginPublishing(script, 2);
  request.mutable_clock_probe()->set_client_time_ns(7);
  send(script, 0, request);
  request.mutable_presented()->set_sequence(1);
  send(script, 0, request);
  for (const auto& message : publishedFrame(3)) send(script, 2, message);
  return script.bytes({kWritten, 0, kWritten, 1, kWritten, 2, kCancel, 2, kWritten, 0}).done();
}

// Frames wait for so long that the second is received and replaces the first.
std::vector<uint8_t> heldStream() {
  SeedWriter script;
  beginPublishing(script, 0);
  script.bytes({kWritten, 0, kHold});
  for (const auto& message : publishedFrame(1)) send(script, 0, message);
  for (int i = 0; i < 5; ++i) script.bytes({kTick, 0});
  for (const auto& message : publishedFrame(2)) send(script, 0, message);
  script.bytes({kWritten, 0, kLetGo});
  return script.bytes({kWritten, 0, kWritten, 0, kHalfClose, 0, kWritten, 0}).done();
}

}  // namespace

SeedBytes headerSeeds() {
  v1::FrameHeader cube = flatHeader(3);
  cube.mutable_sources(0)->set_cube_map(true);
  cube.mutable_sources(0)->clear_camera();
  for (v1::Plane& plane : *cube.mutable_sources(0)->mutable_layers(0)->mutable_planes()) {
    const uint64_t pixel_bytes = plane.bytes_count() / 6;
    plane.mutable_size()->set_width(2);
    plane.mutable_size()->set_height(12);
    plane.set_bytes_count(24 * pixel_bytes);
  }
  v1::FrameHeader two_sources = mirrorHeader();
  *two_sources.add_sources() = two_sources.sources(0);
  return {bytesOf(flatHeader(1)), bytesOf(mirrorHeader()), bytesOf(cube), bytesOf(two_sources)};
}

SeedBytes displaySeeds() {
  v1::OpenDisplay effects = openQuilt();
  effects.mutable_display()->mutable_effects()->mutable_lens()->set_aperture_radius_m(0.05);
  effects.mutable_display()->mutable_effects()->mutable_temporal()->set_output_rate_hz(30);
  v1::OpenDisplay rgbd = openQuilt();
  rgbd.mutable_display()->mutable_rgbd()->mutable_view_size()->set_width(16);
  rgbd.mutable_display()->mutable_rgbd()->mutable_view_size()->set_height(12);
  return {bytesOf(openQuilt()), bytesOf(openTrackedEyes()), bytesOf(effects), bytesOf(rgbd)};
}

SeedBytes eyePosesSeeds() {
  return {bytesOf(twoEyes())};
}

SeedBytes chunkSeeds() {
  const v1::PublishFramesRequest chunk = chunkOf(0, 0, std::string(24, 'c'));
  return {SeedWriter().bytes({255}).text(chunk.SerializeAsString()).done(),
          SeedWriter().bytes({2}).text(chunk.SerializeAsString()).done()};
}

SeedBytes callSeeds() {
  return {watchedStream(), trackedStream(), heldStream()};
}

SeedBytes atlasSeeds() {
  SeedWriter messages;
  for (const auto& message : atlasMessages()) messages.counted(message.SerializeAsString());
  return {messages.done()};
}

SeedBytes recordingSeeds() {
  return {recordingOf(RecordingKind::kFrames, publishedFrame(1)),
          recordingOf(RecordingKind::kAtlases, atlasMessages())};
}

}  // namespace viewloom
