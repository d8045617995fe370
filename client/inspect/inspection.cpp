// SPDX-License-Identifier: Apache-2.0
#include "inspect/inspection.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "inspect/color_pixels.h"
#include "inspect/orientation.h"

namespace viewloom::inspect {
namespace {

constexpr uint32_t kPictureSideMax_px = 1024;
constexpr Rgb kNoSurfaceColor{255, 0, 255};

Rgb depthColor(float inv_z, const DepthMeasures& measures) {
  if (inv_z < 0) return kNoSurfaceColor;
  const float span = std::max(measures.inv_z_near - measures.inv_z_far, 1e-9F);
  const float share = std::clamp((inv_z - measures.inv_z_far) / span, 0.0F, 1.0F);
  const auto grey = static_cast<uint8_t>(std::lround(255 * share));
  return {grey, grey, grey};
}

// One layer of a source, whose first plane has this index among those of the frame.
class LayerLook {
 public:
  LayerLook(const files::LoadedFrame& frame, const v1::Source& source, size_t plane_index)
      : frame_(frame), source_(source), plane_index_(plane_index) {}

  absl::StatusOr<LayerInspection> look(const v1::Layer& layer, const std::stop_token& stop) {
    LayerInspection found{.color = layer.planes(0), .depth = layer.planes(1)};
    absl::StatusOr<DepthSamples> samples =
        readDepthSamples(found.depth, bytes(plane_index_ + 1), source_.camera());
    if (!samples.ok()) return samples.status();
    found.samples = *std::move(samples);
    if (stop.stop_requested()) return stopped();
    found.measures = measureDepth(found.samples);
    if (stop.stop_requested()) return stopped();
    const size_t layer_index = plane_index_ / 2;
    const uint32_t code_max =
        layer_index < frame_.code_max.size() ? frame_.code_max[layer_index] : 0;
    found.suspicions =
        suspectDepth({found.depth, code_max, found.samples, found.measures, source_.cube_map()});
    if (stop.stop_requested()) return stopped();
    // Behind the first layer, colour may well be transparent.
    if (source_.layers_size() == 1) addOfColor(found);
    add(found, suspectShapes(found.color.size(), found.depth.size()));
    return found;
  }

 private:
  static absl::Status stopped() { return absl::CancelledError("the look was broken off"); }

  const std::vector<uint8_t>& bytes(size_t plane_index) const {
    return *frame_.wire.planes[plane_index];
  }

  static void add(LayerInspection& found, const std::vector<Suspicion>& suspicions) {
    found.suspicions.insert(found.suspicions.end(), suspicions.begin(), suspicions.end());
  }

  void addOfColor(LayerInspection& found) const {
    const std::vector<uint8_t>& color_bytes = bytes(plane_index_);
    add(found, suspectAlpha(found.color, measureAlpha(found.color, color_bytes, found.samples)));
    if (source_.cube_map()) return;  // where its faces meet there are edges of no picture
    const auto color = ColorPixels::open(found.color, color_bytes);
    if (color.ok()) add(found, suspectOrientation(edgeAgreement(found.samples, *color)));
  }

  const files::LoadedFrame& frame_;
  const v1::Source& source_;
  const size_t plane_index_;
};

}  // namespace

absl::StatusOr<std::vector<SourceInspection>> inspectFrame(const files::LoadedFrame& frame,
                                                           const std::stop_token& stop) {
  std::vector<SourceInspection> sources;
  size_t plane_index = 0;
  for (const v1::Source& source : frame.wire.header.sources()) {
    SourceInspection& inspected = sources.emplace_back();
    inspected.camera = source.camera();
    for (const v1::Layer& layer : source.layers()) {
      auto found = LayerLook(frame, source, plane_index).look(layer, stop);
      if (!found.ok()) {
        return withFieldPrefix(found.status(), strCat("sources[", sources.size() - 1, "]"));
      }
      inspected.layers.push_back(*std::move(found));
      plane_index += 2;
    }
  }
  return sources;
}

absl::StatusOr<InspectionPicture> drawInspection(const LayerInspection& layer,
                                                 const std::vector<uint8_t>& color_bytes) {
  const absl::StatusOr<ColorPixels> pixels = ColorPixels::open(layer.color, color_bytes);
  if (!pixels.ok()) return pixels.status();
  const DepthSamples& samples = layer.samples;
  const uint32_t longest_px = std::max(samples.width_px, samples.height_px);
  const uint32_t stride = (longest_px + kPictureSideMax_px - 1) / kPictureSideMax_px;
  const uint32_t half_px = (samples.width_px + stride - 1) / stride;
  InspectionPicture picture{
      .width_px = 2 * half_px, .height_px = (samples.height_px + stride - 1) / stride, .rgb = {}};
  picture.rgb.resize(size_t{3} * picture.width_px * picture.height_px);
  for (uint32_t y = 0; y < picture.height_px; ++y) {
    for (uint32_t x = 0; x < half_px; ++x) {
      const size_t index = size_t{y} * stride * samples.width_px + size_t{x} * stride;
      const Rgb left =
          pixels->at((x * stride + 0.5) / samples.width_px, (y * stride + 0.5) / samples.height_px);
      const Rgb right = depthColor(samples.inv_z[index], layer.measures);
      uint8_t* const row = &picture.rgb[size_t{3} * y * picture.width_px];
      std::copy(left.begin(), left.end(), row + size_t{3} * x);
      std::copy(right.begin(), right.end(), row + size_t{3} * (half_px + x));
    }
  }
  return picture;
}

}  // namespace viewloom::inspect
