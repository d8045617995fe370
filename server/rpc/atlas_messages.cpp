// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_messages.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "base/check.h"
#include "messages/wire_message.h"
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

// Strips of a plane of an image, where others take turns with it.
constexpr size_t kTurnCount = 8;

bool areOneJpegFile(BandEncoding encoding) {
  return encoding == BandEncoding::kJpeg || encoding == BandEncoding::kJpegPlanes;
}

// The bands of one plane of an image.
struct PlaneBands {
  uint32_t image_index = 0;
  AtlasPlane plane = AtlasPlane::kColor;
  size_t first_band = 0;
  size_t band_count = 0;
};

// Sorted by image in the order of the pictures, then plane.
std::vector<PlaneBands> planeBandsOf(const EncodedAtlas& atlas) {
  std::vector<PlaneBands> planes;
  for (size_t i = 0; i < atlas.bands.size(); ++i) {
    const EncodedBand& band = atlas.bands[i];
    if (i == 0 || band.image_index != planes.back().image_index ||
        band.plane != planes.back().plane) {
      planes.push_back({.image_index = band.image_index, .plane = band.plane, .first_band = i});
    }
    ++planes.back().band_count;
  }
  if (atlas.picture_order == PictureOrder::kForward) {
    std::ranges::stable_sort(planes, std::less(), &PlaneBands::image_index);
  } else {
    std::ranges::stable_sort(planes, std::greater(), &PlaneBands::image_index);
  }
  return planes;
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

AtlasMessages::AtlasMessages(GrowingAtlasPtr growing, size_t viewer_count)
    : growing_(std::move(growing)),
      atlas_(growing_->atlas()),
      viewer_count_(viewer_count),
      strips_(stripsOf(atlas_)) {}

// How many there are, and their order, does not depend on what is packed when.
std::vector<AtlasMessages::Strip> AtlasMessages::stripsOf(const EncodedAtlas& atlas) {
  const std::vector<PlaneBands> planes = planeBandsOf(atlas);
  std::vector<Strip> strips;
  for (auto image = planes.begin(); image != planes.end();) {
    const auto end = std::find_if(image, planes.end(), [&](const PlaneBands& plane) {
      return plane.image_index != image->image_index;
    });
    const size_t turn_count = end - image == 1 ? 1 : kTurnCount;
    for (size_t turn = 0; turn < turn_count; ++turn) {
      for (auto plane = image; plane != end; ++plane) {
        const size_t begin = plane->band_count * turn / turn_count;
        const size_t count = plane->band_count * (turn + 1) / turn_count - begin;
        const size_t first = plane->first_band + begin;
        if (count > 0 && areOneJpegFile(atlas.bands[first].encoding)) {
          strips.push_back({.first_band = first, .band_count = count});
        } else {
          for (size_t i = 0; i < count; ++i) strips.push_back({first + i, 1});
        }
      }
    }
    image = end;
  }
  return strips;
}

bool AtlasMessages::mayBegin(const std::weak_ptr<AtlasReader>& reader) const {
  return growing_->await(wanted(), reader) > 0;
}

// The rest of the strip, of which so much leaves together.
BandsWanted AtlasMessages::wanted() const {
  if (strip_ == strips_.size()) return {};
  const Strip& strip = strips_[strip_];
  const bool is_first = strip_ == 0 && strip_offset_bytes_ == 0;
  const bool waits_for_nothing = (is_first && viewer_count_ == 1) || band_offset_bytes_ > 0;
  const size_t bytes_min = std::min(kPieceBytesMin * viewer_count_, kPieceBytesMax);
  return {.first = strip.first_band + band_,
          .last = strip.first_band + strip.band_count,
          .bytes_min = waits_for_nothing ? 1 : bytes_min};
}

GrowingAtlas::State AtlasMessages::state() const {
  const GrowingAtlas::State state = growing_->state();
  const bool is_given_up = has_given_up_ && state == GrowingAtlas::State::kGrowing;
  return is_given_up ? GrowingAtlas::State::kAbandoned : state;
}

bool AtlasMessages::isReady() const {
  if (!has_begun_) return true;
  const GrowingAtlas::State now = state();
  if (now == GrowingAtlas::State::kAbandoned) return true;
  if (strip_ == strips_.size()) return now == GrowingAtlas::State::kWhole;
  return growing_->readyCount(wanted()) > 0;
}

std::optional<grpc::ByteBuffer> AtlasMessages::next(const std::weak_ptr<AtlasReader>& reader) {
  VIEWLOOM_CHECK(!done());
  if (!has_begun_) {
    has_begun_ = true;
    return header();
  }
  const size_t ready_count = growing_->await(wanted(), reader);
  const GrowingAtlas::State now = state();
  const bool is_over = strip_ == strips_.size() && now == GrowingAtlas::State::kWhole;
  if (is_over || now == GrowingAtlas::State::kAbandoned) return last(now);
  if (ready_count == 0) return std::nullopt;
  return nextPiece(ready_count);
}

grpc::ByteBuffer AtlasMessages::header() const {
  v1::StreamAtlasesResponse response;
  v1::AtlasHeader& header = *response.mutable_header();
  header.set_sequence(atlas_.sequence);
  header.set_frame_number(atlas_.frame_number);
  header.set_capture_time_ns(atlas_.capture_time_ns);
  *header.mutable_source_camera() = cameraToProto(atlas_.source_camera);
  *header.mutable_display_pose() = poseToProto(atlas_.display_pose);
  header.set_present_at_ns(atlas_.present_at_ns);
  header.set_band_count(static_cast<uint32_t>(strips_.size()));
  *header.mutable_stats() = statsToProto(atlas_.stats);
  header.set_method(methodToProto(atlas_.method));
  if (atlas_.depth_budget) *header.mutable_depth_budget() = budgetToProto(*atlas_.depth_budget);
  header.set_eye_poses_time_ns(atlas_.eye_poses_time_ns);
  header.set_predicted_display_time_ns(atlas_.predicted_display_time_ns);
  header.set_eye_poses_latched_ns(atlas_.eye_poses_latched_ns);
  header.set_eye_poses_age_ns(atlas_.eye_poses_age_ns);
  header.set_shown_time_ns(atlas_.shown_time_ns);
  header.set_defaults_count(atlas_.taking.count);
  header.set_defaults_reason(reasonToProto(atlas_.taking.reason));
  header.set_timing(timingToProto(atlas_.timing));
  header.set_reference_sequence(atlas_.reference_sequence);
  header.set_is_backward(atlas_.picture_order == PictureOrder::kBackward);
  header.set_discardable(!isChained(atlas_.encoding));
  header.set_video_qp(atlas_.video_qp);
  for (const ViewsOutside& views : viewsOutside(atlas_.outside_shares)) {
    *header.add_views_outside() = outsideToProto(views);
  }
  return bytesFromMessage(response);
}

// The next message: as many ready bands as it holds, or a part of the first.
grpc::ByteBuffer AtlasMessages::nextPiece(size_t ready_count) {
  const Strip& strip = strips_[strip_];
  const std::span all = std::span(atlas_.bands).subspan(strip.first_band, strip.band_count);
  const std::span ready = all.subspan(band_, ready_count);
  v1::Band proto;
  proto.set_sequence(atlas_.sequence);
  proto.set_image_index(all.front().image_index);
  proto.set_plane(planeToProto(all.front().plane));
  proto.set_first_row(all.front().first_row);
  proto.set_row_count(all.back().first_row + all.back().row_count - all.front().first_row);
  proto.set_encoding(bandEncodingToProto(all.front().encoding));
  proto.set_offset_bytes(static_cast<uint32_t>(strip_offset_bytes_));
  std::vector<grpc::Slice> slices{grpc::Slice()};  // the first is what comes before the data
  size_t data_bytes = 0;
  for (const EncodedBand& band : ready) {
    const size_t left_bytes = band.bytes->size() - band_offset_bytes_;
    if (data_bytes > 0 && data_bytes + left_bytes > kPieceBytesMax) break;
    const size_t count = std::min(left_bytes, kPieceBytesMax);
    slices.push_back(sliceOf(band.bytes, band_offset_bytes_, count));
    data_bytes += count;
    band_offset_bytes_ += count;
    if (count < left_bytes) break;
    band_offset_bytes_ = 0;
    ++band_;
  }
  strip_offset_bytes_ += data_bytes;
  const bool is_last_piece = band_ == strip.band_count;
  proto.set_last_piece(is_last_piece);
  if (is_last_piece) {
    band_ = 0;
    strip_offset_bytes_ = 0;
    ++strip_;
  }
  slices.front() = grpc::Slice(headOfMessage(proto, kBandData, data_bytes));
  return grpc::ByteBuffer(slices.data(), slices.size());
}

grpc::ByteBuffer AtlasMessages::last(GrowingAtlas::State outcome) {
  outcome_ = outcome;
  v1::StreamAtlasesResponse response;
  if (!wasWhole()) {
    response.mutable_abandoned()->set_sequence(atlas_.sequence);
    return bytesFromMessage(response);
  }
  v1::AtlasEnd& end = *response.mutable_end();
  end.set_sequence(atlas_.sequence);
  *end.mutable_times() = timesToProto(atlas_.times);
  *end.mutable_coverage() = coverageToProto(atlas_.coverage);
  if (atlas_.reflections.rayCount() > 0) {
    *end.mutable_reflections() = reflectionsToProto(atlas_.reflections);
  }
  return bytesFromMessage(response);
}

}  // namespace viewloom
