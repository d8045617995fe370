// SPDX-License-Identifier: Apache-2.0
#include "web/atlas_message.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "frame/timing.h"
#include "web/catalog_json.h"

namespace viewloom {
namespace {

using nlohmann::json;

json timesJson(const StageTimes& times) {
  return {{"receive_ns", times.receive_ns}, {"decode_ns", times.decode_ns},
          {"upload_ns", times.upload_ns},   {"build_ns", times.build_ns},
          {"retime_ns", times.retime_ns},   {"wait_ns", times.wait_ns},
          {"trace_ns", times.trace_ns},     {"encode_ns", times.encode_ns},
          {"total_ns", times.total_ns}};
}

// Shares of all rays.
json coverageJson(const Coverage& coverage) {
  const double rays = static_cast<double>(coverage.rayCount());
  const auto share = [rays](uint64_t count) {
    return rays > 0 ? static_cast<double>(count) / rays : 0.0;
  };
  return {{"hit", share(coverage.hit)},
          {"hit_assumed", share(coverage.hit_assumed)},
          {"hidden", share(coverage.hidden)},
          {"outside", share(coverage.outside)},
          {"empty", share(coverage.empty)}};
}

// From the first image to the last, also where pictures of video come backward.
std::vector<const EncodedBand*> depthBands(const EncodedAtlas& atlas) {
  std::vector<const EncodedBand*> bands;
  for (const EncodedBand& band : atlas.bands) {
    if (band.plane == AtlasPlane::kDepth) bands.push_back(&band);
  }
  std::ranges::stable_sort(bands, {}, &EncodedBand::image_index);
  return bands;
}

uint64_t depthBytes(const EncodedAtlas& atlas) {
  uint64_t size_bytes = 0;
  for (const EncodedBand* band : depthBands(atlas)) size_bytes += band->bytes->size();
  return size_bytes;
}

const char* reasonText(DefaultsReason reason) {
  switch (reason) {
    case DefaultsReason::kFirstFrame:
      return "first_frame";
    case DefaultsReason::kNewPublisher:
      return "new_publisher";
    case DefaultsReason::kDepthMoved:
      return "depth_moved";
  }
  return "";
}

uint64_t sizeOf(const std::vector<SharedBytes>& bands) {
  uint64_t size_bytes = 0;
  for (const SharedBytes& band : bands) size_bytes += band->size();
  return size_bytes;
}

json budgetJson(const DepthBudget& budget) {
  return {{"disparity_max_px", budget.disparity_max_px},
          {"beyond_fusing_share", budget.beyond_fusing_share},
          {"beyond_ghosting_share", budget.beyond_ghosting_share},
          {"suggested_focal_distance_m", budget.suggested_focal_distance_m},
          {"suggested_view_cone_rad", budget.suggested_view_cone_rad}};
}

json outsideJson(const std::vector<double>& shares) {
  json runs = json::array();
  for (const ViewsOutside& views : viewsOutside(shares)) {
    runs.push_back(
        {{"first_view", views.first_view}, {"last_view", views.last_view}, {"share", views.share}});
  }
  return runs;
}

bool isVideo(const EncodedAtlas& atlas) {
  return atlas.encoding.color == BandEncoding::kH264;
}

// Rows, and bytes, of each band: compact depth is unpacked band by band. Rows of the pictures of a
// video follow each other.
json depthBandsJson(const EncodedAtlas& atlas) {
  const uint32_t image_rows = atlas.layout->imageSize().height;
  json bands = json::array();
  for (const EncodedBand* band : depthBands(atlas)) {
    bands.push_back({{"first_row", image_rows * band->image_index + band->first_row},
                     {"row_count", band->row_count},
                     {"bytes", band->bytes->size()}});
  }
  return bands;
}

// Which eye poses a tracked display shows. Times of the client are its own clock's.
json eyesJson(const EncodedAtlas& atlas) {
  return {{"time_ns", std::to_string(atlas.eye_poses_time_ns)},
          {"predicted_display_time_ns", std::to_string(atlas.predicted_display_time_ns)},
          {"latched_ns", std::to_string(atlas.eye_poses_latched_ns)},
          {"age_ns", atlas.eye_poses_age_ns}};
}

json headerJson(const EncodedAtlas& atlas, const Delivery& delivery) {
  json header = {{"sequence", atlas.sequence},
                 {"frame_number", std::to_string(atlas.frame_number)},
                 {"capture_time_ns", std::to_string(atlas.capture_time_ns)},
                 {"shown_time_ns", std::to_string(atlas.shown_time_ns)},
                 {"timing", timingText(atlas.timing)},
                 {"present_at_ns", std::to_string(atlas.present_at_ns)},
                 {"layout", layoutJson(*atlas.layout)},
                 {"encoding", encodingJson(atlas.encoding)},
                 {"times", timesJson(atlas.times)},
                 {"coverage", coverageJson(atlas.coverage)},
                 {"defaults_count", atlas.taking.count},
                 {"defaults_reason", reasonText(atlas.taking.reason)},
                 {"method", atlas.method == TraceMethod::kSweep ? "sweep" : "walk"},
                 {"jpeg_bytes", isVideo(atlas) ? 0 : sizeOf(colorBands(atlas))},
                 {"depth_bytes", depthBytes(atlas)},
                 {"delivery", delivery.delivery},
                 {"change_count", delivery.change_count},
                 {"dropped_count", delivery.dropped_count},
                 {"mailbox_ns", delivery.mailbox_ns},
                 {"shown_ns", delivery.shown_ns}};
  if (isVideo(atlas)) {
    header["video_qp"] = atlas.video_qp;
    header["reference_sequence"] = atlas.reference_sequence;
    header["is_backward"] = atlas.picture_order == PictureOrder::kBackward;
    for (const SharedBytes& picture : colorBands(atlas)) {
      header["picture_bytes"].push_back(picture->size());
    }
  }
  if (atlas.encoding.with_depth && atlas.encoding.planes == BandEncoding::kCompactDepth) {
    header["depth_bands"] = depthBandsJson(atlas);
  }
  if (atlas.eye_poses_latched_ns != 0) header["eyes"] = eyesJson(atlas);
  header["views_outside"] = outsideJson(atlas.outside_shares);
  if (atlas.depth_budget) header["depth_budget"] = budgetJson(*atlas.depth_budget);
  return header;
}

}  // namespace

AtlasMessage::AtlasMessage(AtlasPtr atlas, const Delivery& delivery)
    : atlas_(std::move(atlas)), header_(headerJson(*atlas_, delivery).dump()) {
  const size_t length = header_.size();
  for (size_t i = 0; i < header_length_.size(); ++i) {
    header_length_[i] = static_cast<uint8_t>(length >> (8 * i));
  }
  parts_.emplace_back(header_length_);
  parts_.emplace_back(reinterpret_cast<const uint8_t*>(header_.data()), length);
  for (const SharedBytes& band : colorBands(*atlas_)) parts_.emplace_back(*band);
  for (const EncodedBand* band : depthBands(*atlas_)) parts_.emplace_back(*band->bytes);
}

uint64_t AtlasMessage::sizeBytes() const {
  uint64_t size_bytes = 0;
  for (const auto& part : parts_) size_bytes += part.size();
  return size_bytes;
}

std::vector<SharedBytes> colorBands(const EncodedAtlas& atlas) {
  std::vector<SharedBytes> bands;
  for (const EncodedBand& band : atlas.bands) {
    if (band.plane == AtlasPlane::kColor) bands.push_back(band.bytes);
  }
  return bands;
}

}  // namespace viewloom
