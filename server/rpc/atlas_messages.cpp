// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/check.h"
#include "messages/wire_message.h"
#include "rpc/geometry_to_proto.h"
#include "rpc/layout_to_proto.h"
#include "rpc/report_to_proto.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {
namespace {

v1::AtlasPlane planeToProto(AtlasPlane plane) {
  switch (plane) {
    case AtlasPlane::kColor:
      return v1::ATLAS_PLANE_COLOR;
    case AtlasPlane::kRed:
      return v1::ATLAS_PLANE_RED;
    case AtlasPlane::kGreen:
      return v1::ATLAS_PLANE_GREEN;
    case AtlasPlane::kBlue:
      return v1::ATLAS_PLANE_BLUE;
    case AtlasPlane::kDepth:
      return v1::ATLAS_PLANE_DEPTH;
    case AtlasPlane::kMask:
      return v1::ATLAS_PLANE_MASK;
    case AtlasPlane::kDepthCodes:
      return v1::ATLAS_PLANE_DEPTH_CODES;
  }
  VIEWLOOM_CHECK(false && "unknown AtlasPlane");
  return v1::ATLAS_PLANE_UNSPECIFIED;
}

v1::TraceMethod methodToProto(TraceMethod method) {
  return method == TraceMethod::kSweep ? v1::TRACE_METHOD_SWEEP : v1::TRACE_METHOD_WALK;
}

v1::Timing timingToProto(Timing timing) {
  switch (timing) {
    case Timing::kCaptured:
      return v1::TIMING_CAPTURED;
    case Timing::kPredicted:
      return v1::TIMING_PREDICTED;
    case Timing::kInterpolated:
      return v1::TIMING_INTERPOLATED;
    case Timing::kHeld:
      return v1::TIMING_HELD;
  }
  VIEWLOOM_CHECK(false && "unknown Timing");
  return v1::TIMING_UNSPECIFIED;
}

v1::DefaultsReason reasonToProto(DefaultsReason reason) {
  switch (reason) {
    case DefaultsReason::kFirstFrame:
      return v1::DEFAULTS_REASON_FIRST_FRAME;
    case DefaultsReason::kNewPublisher:
      return v1::DEFAULTS_REASON_NEW_PUBLISHER;
    case DefaultsReason::kDepthMoved:
      return v1::DEFAULTS_REASON_DEPTH_MOVED;
  }
  VIEWLOOM_CHECK(false && "unknown DefaultsReason");
  return v1::DEFAULTS_REASON_UNSPECIFIED;
}

// Whether the data of two bands that follow each other, joined, are those of one (BandEncoding).
bool areOneJoined(const EncodedBand& band, const EncodedBand& next) {
  const bool is_same_plane = band.image_index == next.image_index && band.plane == next.plane;
  const bool adjoins = band.first_row + band.row_count == next.first_row;
  return is_same_plane && adjoins && band.encoding == next.encoding &&
         band.encoding != BandEncoding::kZstd;
}

constexpr DataFields kBandData{.part = v1::StreamAtlasesResponse::kBandFieldNumber,
                               .data = v1::Band::kDataFieldNumber};

}  // namespace

std::string layoutMessage(const EncodedAtlas& atlas) {
  v1::StreamAtlasesResponse response;
  *response.mutable_layout() = layoutToProto(*atlas.layout, atlas.encoding);
  return response.SerializeAsString();
}

grpc::ByteBuffer skippedMessage(uint64_t count) {
  v1::StreamAtlasesResponse response;
  response.mutable_skipped()->set_count(count);
  return bytesFromMessage(response);
}

AtlasMessages::AtlasMessages(AtlasPtr atlas)
    : atlas_(std::move(atlas)), strips_(stripsOf(*atlas_)) {}

std::vector<AtlasMessages::Strip> AtlasMessages::stripsOf(const EncodedAtlas& atlas) {
  std::vector<Strip> strips;
  for (size_t i = 0; i < atlas.bands.size(); ++i) {
    const size_t byte_count = atlas.bands[i].bytes->size();
    if (i > 0 && areOneJoined(atlas.bands[i - 1], atlas.bands[i]) &&
        strips.back().byte_count + byte_count <= kPieceBytesMax) {
      ++strips.back().band_count;
      strips.back().byte_count += byte_count;
    } else {
      strips.push_back({.first_band = i, .band_count = 1, .byte_count = byte_count});
    }
  }
  return strips;
}

grpc::ByteBuffer AtlasMessages::next() {
  VIEWLOOM_CHECK(!done());
  if (part_ == Part::kHeader) {
    part_ = strips_.empty() ? Part::kEnd : Part::kBands;
    return header();
  }
  if (part_ == Part::kBands) return nextPiece();
  part_ = Part::kDone;
  return endMessage();
}

grpc::ByteBuffer AtlasMessages::header() const {
  v1::StreamAtlasesResponse response;
  v1::AtlasHeader& header = *response.mutable_header();
  header.set_sequence(atlas_->sequence);
  header.set_frame_number(atlas_->frame_number);
  header.set_capture_time_ns(atlas_->capture_time_ns);
  *header.mutable_source_camera() = cameraToProto(atlas_->source_camera);
  *header.mutable_display_pose() = poseToProto(atlas_->display_pose);
  header.set_present_at_ns(atlas_->present_at_ns);
  *header.mutable_times() = timesToProto(atlas_->times);
  *header.mutable_coverage() = coverageToProto(atlas_->coverage);
  header.set_band_count(static_cast<uint32_t>(strips_.size()));
  if (atlas_->reflections.rayCount() > 0) {
    *header.mutable_reflections() = reflectionsToProto(atlas_->reflections);
  }
  *header.mutable_stats() = statsToProto(atlas_->stats);
  header.set_method(methodToProto(atlas_->method));
  if (atlas_->depth_budget) *header.mutable_depth_budget() = budgetToProto(*atlas_->depth_budget);
  header.set_eye_poses_time_ns(atlas_->eye_poses_time_ns);
  header.set_predicted_display_time_ns(atlas_->predicted_display_time_ns);
  header.set_eye_poses_latched_ns(atlas_->eye_poses_latched_ns);
  header.set_eye_poses_age_ns(atlas_->eye_poses_age_ns);
  header.set_shown_time_ns(atlas_->shown_time_ns);
  header.set_defaults_count(atlas_->taking.count);
  header.set_defaults_reason(reasonToProto(atlas_->taking.reason));
  header.set_timing(timingToProto(atlas_->timing));
  for (const ViewsOutside& views : viewsOutside(atlas_->outside_shares)) {
    *header.add_views_outside() = outsideToProto(views);
  }
  return bytesFromMessage(response);
}

grpc::ByteBuffer AtlasMessages::nextPiece() {
  const Strip& strip = strips_[strip_];
  const std::span bands = std::span(atlas_->bands).subspan(strip.first_band, strip.band_count);
  const EncodedBand& first = bands.front();
  const EncodedBand& last = bands.back();
  const size_t data_bytes = std::min(strip.byte_count - offset_bytes_, kPieceBytesMax);
  const bool last_piece = offset_bytes_ + data_bytes == strip.byte_count;
  v1::Band proto;
  proto.set_sequence(atlas_->sequence);
  proto.set_image_index(first.image_index);
  proto.set_plane(planeToProto(first.plane));
  proto.set_first_row(first.first_row);
  proto.set_row_count(last.first_row + last.row_count - first.first_row);
  proto.set_encoding(bandEncodingToProto(first.encoding));
  proto.set_offset_bytes(static_cast<uint32_t>(offset_bytes_));
  proto.set_last_piece(last_piece);
  std::vector<grpc::Slice> slices{grpc::Slice(headOfMessage(proto, kBandData, data_bytes))};
  for (const EncodedBand& band : bands) {
    const size_t count = std::min(band.bytes->size() - offset_bytes_, kPieceBytesMax);
    slices.push_back(sliceOf(band.bytes, offset_bytes_, count));
  }
  offset_bytes_ += data_bytes;
  if (last_piece) {
    offset_bytes_ = 0;
    if (++strip_ == strips_.size()) part_ = Part::kEnd;
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

grpc::ByteBuffer AtlasMessages::endMessage() const {
  v1::StreamAtlasesResponse response;
  response.mutable_end()->set_sequence(atlas_->sequence);
  return bytesFromMessage(response);
}

}  // namespace viewloom
