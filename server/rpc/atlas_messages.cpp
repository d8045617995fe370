// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <algorithm>
#include <array>

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/wire_format_lite.h>

#include "base/check.h"
#include "rpc/geometry_to_proto.h"
#include "rpc/layout_to_proto.h"
#include "rpc/report_to_proto.h"
#include "rpc/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedOutputStream;

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

void writeBytesTag(CodedOutputStream& output, int field_number, size_t byte_count) {
  output.WriteTag(WireFormatLite::MakeTag(field_number, WireFormatLite::WIRETYPE_LENGTH_DELIMITED));
  output.WriteVarint32(static_cast<uint32_t>(byte_count));
}

// All of a StreamAtlasesResponse that holds this band, up to the bytes of its data, which come last
// because data is the band's highest field.
std::string prefixOf(const v1::Band& band_without_data, size_t data_bytes) {
  std::string band = band_without_data.SerializeAsString();
  {
    google::protobuf::io::StringOutputStream stream(&band);  // appends
    CodedOutputStream output(&stream);
    writeBytesTag(output, v1::Band::kDataFieldNumber, data_bytes);
  }
  std::string prefix;
  {
    google::protobuf::io::StringOutputStream stream(&prefix);
    CodedOutputStream output(&stream);
    writeBytesTag(output, v1::StreamAtlasesResponse::kBandFieldNumber, band.size() + data_bytes);
  }
  return prefix + band;
}

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

grpc::ByteBuffer AtlasMessages::next() {
  VIEWLOOM_CHECK(!done());
  if (part_ == Part::kHeader) {
    part_ = atlas_->bands.empty() ? Part::kEnd : Part::kBands;
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
  header.set_band_count(static_cast<uint32_t>(atlas_->bands.size()));
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
  header.set_timing(timingToProto(atlas_->timing));
  for (const ViewsOutside& views : viewsOutside(atlas_->outside_shares)) {
    *header.add_views_outside() = outsideToProto(views);
  }
  return bytesFromMessage(response);
}

grpc::ByteBuffer AtlasMessages::nextPiece() {
  const EncodedBand& band = atlas_->bands[band_];
  const size_t data_bytes = std::min(band.bytes->size() - offset_bytes_, kPieceBytesMax);
  const bool last_piece = offset_bytes_ + data_bytes == band.bytes->size();
  v1::Band proto;
  proto.set_sequence(atlas_->sequence);
  proto.set_image_index(band.image_index);
  proto.set_plane(planeToProto(band.plane));
  proto.set_first_row(band.first_row);
  proto.set_row_count(band.row_count);
  proto.set_encoding(bandEncodingToProto(band.encoding));
  proto.set_offset_bytes(static_cast<uint32_t>(offset_bytes_));
  proto.set_last_piece(last_piece);
  const std::array<grpc::Slice, 2> slices{grpc::Slice(prefixOf(proto, data_bytes)),
                                          sliceOf(band.bytes, offset_bytes_, data_bytes)};
  offset_bytes_ += data_bytes;
  if (last_piece) {
    offset_bytes_ = 0;
    if (++band_ == atlas_->bands.size()) part_ = Part::kEnd;
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

grpc::ByteBuffer AtlasMessages::endMessage() const {
  v1::StreamAtlasesResponse response;
  response.mutable_end()->set_sequence(atlas_->sequence);
  return bytesFromMessage(response);
}

}  // namespace viewloom
