// SPDX-License-Identifier: Apache-2.0
#include "web/catalog_json.h"

#include <nlohmann/json.hpp>

#include "display/named_display.h"
#include "video/h264_parameters.h"

namespace viewloom {

using nlohmann::json;

namespace {

json sizeJson(SizePx size_px) {
  return {{"width", size_px.width}, {"height", size_px.height}};
}

constexpr size_t kListedViewsMax = 2;

json cameraJson(const Camera& camera) {
  const auto& [pose, intrinsics] = camera;
  return {{"pose",
           {{"position",
             {{"x", pose.position_m.x}, {"y", pose.position_m.y}, {"z", pose.position_m.z}}},
            {"orientation",
             {{"x", pose.orientation.x},
              {"y", pose.orientation.y},
              {"z", pose.orientation.z},
              {"w", pose.orientation.w}}}}},
          {"intrinsics",
           {{"focal_x_px", intrinsics.focal_px.x},
            {"focal_y_px", intrinsics.focal_px.y},
            {"principal_x_px", intrinsics.principal_px.x},
            {"principal_y_px", intrinsics.principal_px.y}}}};
}

json streamJson(const StreamEntry& entry, uint32_t subscriber_count) {
  return {{"name", entry.name},
          {"live", entry.live},
          {"frame_number", std::to_string(entry.frame_number)},
          {"size", sizeJson(entry.size_px)},
          {"layer_count", entry.layer_count},
          {"rate_hz", entry.rate_hz},
          {"received_count", entry.received_count},
          {"replaced_count", entry.replaced_count},
          {"refused_count", entry.refused_count},
          {"used_count", entry.used_count},
          {"subscriber_count", subscriber_count}};
}

json stackJson(const VideoStack& stack) {
  return {{"picture_count", stack.picture_count},
          {"picture_size", sizeJson(stack.pictureSize())},
          {"columns", stack.columns},
          {"rows", stack.rows},
          {"cell_size", sizeJson(stack.cell_px)},
          {"codec_string", codedVideoString(stack.pictureSize())},
          {"color_matrix", "BT601"},
          {"full_range", true}};
}

}  // namespace

json layoutJson(const AtlasLayout& layout) {
  const TileArrangementPx shown = layout.shown();
  json described = {{"size", sizeJson(shown.size_px)},
                    {"columns", shown.columns},
                    {"rows", shown.rows},
                    {"tile_size", sizeJson(shown.tile_size_px)},
                    {"order", shown.order == TileOrder::kBottomLeft ? "BOTTOM_LEFT" : "TOP_LEFT"},
                    {"aspect", layout.aspect},
                    {"view_count", layout.views.size()},
                    {"padding_right_px", shown.padding_right_px},
                    {"padding_top_px", shown.padding_top_px},
                    {"view_cone_rad", layout.view_cone_rad},
                    {"cone_begin", layout.cone_begin},
                    {"cone_end", layout.cone_end},
                    {"focal_distance_m", layout.focal_distance_m},
                    {"suffix", layout.suffix}};
  if (layout.stack) described["video"] = stackJson(*layout.stack);
  if (layout.views.size() > kListedViewsMax) return described;
  described["views"] = json::array();
  for (const View& view : layout.views) described["views"].push_back(cameraJson(view.camera));
  return described;
}

json encodingJson(const EncodingSpec& encoding) {
  if (encoding.color == BandEncoding::kH264) {
    return {{"color", "H264"},
            {"jpeg_quality", encoding.jpeg_quality},
            {"video_qp", encoding.video_qp},
            {"bits_per_second_max", encoding.bits_per_second_max},
            {"video_rung", rungNumber(encoding)},
            {"prediction", isChained(encoding) ? "ACROSS_ATLASES" : "WITHIN_ATLAS"}};
  }
  return {{"jpeg_quality", encoding.jpeg_quality},
          {"chroma", encoding.chroma == Chroma::k444 ? "444" : "420"}};
}

json streamsJson(const StreamDirectory& streams, const Broadcaster& broadcaster,
                 const Caller& caller) {
  json entries = json::array();
  for (const StreamEntry& entry : streams.list()) {
    if (!caller.sees(entry.name)) continue;
    entries.push_back(streamJson(entry, broadcaster.subscriberCount(entry.name)));
  }
  return {{"streams", std::move(entries)}};
}

json displaysJson(const Broadcaster& broadcaster, const Caller& caller) {
  json entries = json::array();
  for (const ActiveDisplayPtr& display : broadcaster.displays("")) {
    if (!caller.sees(display->stream)) continue;
    const auto layout = broadcaster.layout(display->id);
    entries.push_back({{"id", display->id},
                       {"stream", display->stream},
                       {"layout", layout ? layoutJson(*layout) : json()},
                       {"encoding", encodingJson(display->encoding)},
                       {"subscriber_count", display->subscriber_count},
                       {"atlas_count", broadcaster.atlasCount(display->id)}});
  }
  return {{"displays", std::move(entries)}};
}

json presetsJson() {
  json entries = json::array();
  for (const NamedDevice& known : namedDevices()) {
    json entry = {{"name", known.device.name},
                  {"device", known.device.device},
                  {"kinds", known.kinds},
                  {"note", known.device.note}};
    if (known.device.has_size) entry["layout"] = layoutJson(known.layout);
    entries.push_back(std::move(entry));
  }
  return {{"presets", std::move(entries)}};
}

json fieldsJson() {
  json fields = json::object();
  for (const auto& [path, range] : fieldRanges()) {
    fields[path] = {{"min", range.min}, {"max", range.max}};
  }
  return {{"fields", std::move(fields)}};
}

}  // namespace viewloom
