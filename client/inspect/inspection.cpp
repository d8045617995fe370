// SPDX-License-Identifier: Apache-2.0
#include "inspect/inspection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "base/str_cat.h"
#include "files/jpeg_image.h"

namespace viewloom::inspect {
namespace {

constexpr uint32_t kPictureSideMax_px = 1024;
using Rgb = std::array<uint8_t, 3>;
constexpr Rgb kNoSurfaceColor{255, 0, 255};

uint8_t srgbFromLinear(float linear) {
  const float clipped = std::clamp(linear, 0.0F, 1.0F);
  const float encoded =
      clipped <= 0.0031308F ? 12.92F * clipped : 1.055F * std::pow(clipped, 1 / 2.4F) - 0.055F;
  return static_cast<uint8_t>(std::lround(255 * encoded));
}

// Pixels of a colour plane, as the wire has them.
class ColorPixels {
 public:
  ColorPixels(const v1::Plane& plane, const std::vector<uint8_t>& bytes)
      : plane_(plane), bytes_(bytes) {}

  // `x_share`, `y_share`: of the sides, 0..1.
  Rgb at(double x_share, double y_share) const {
    const auto x = static_cast<size_t>(x_share * plane_.size().width());
    const auto y = static_cast<size_t>(y_share * plane_.size().height());
    const size_t index = y * plane_.size().width() + x;
    if (plane_.encoding() == v1::PLANE_ENCODING_RGBA16F) return linearAt(8 * index);
    const size_t pixel_bytes = plane_.encoding() == v1::PLANE_ENCODING_RGBA8 ? 4 : 3;
    const uint8_t* const pixel = &bytes_[pixel_bytes * index];
    return {pixel[0], pixel[1], pixel[2]};
  }

 private:
  Rgb linearAt(size_t offset) const {
    std::array<uint16_t, 3> halves{};
    std::memcpy(halves.data(), &bytes_[offset], sizeof(halves));
    Rgb rgb{};
    for (size_t i = 0; i < 3; ++i) rgb[i] = srgbFromLinear(glm::unpackHalf1x16(halves[i]));
    return rgb;
  }

  const v1::Plane& plane_;
  const std::vector<uint8_t>& bytes_;
};

Rgb depthColor(float inv_z, const DepthMeasures& measures) {
  if (inv_z < 0) return kNoSurfaceColor;
  const float span = std::max(measures.inv_z_near - measures.inv_z_far, 1e-9F);
  const float share = std::clamp((inv_z - measures.inv_z_far) / span, 0.0F, 1.0F);
  const auto grey = static_cast<uint8_t>(std::lround(255 * share));
  return {grey, grey, grey};
}

}  // namespace

absl::StatusOr<std::vector<SourceInspection>> inspectFrame(const files::LoadedFrame& frame) {
  std::vector<SourceInspection> sources;
  size_t plane_index = 0, layer_index = 0;
  for (const v1::Source& source : frame.wire.header.sources()) {
    SourceInspection& inspected = sources.emplace_back();
    inspected.camera = source.camera();
    for (const v1::Layer& layer : source.layers()) {
      LayerInspection found{.color = layer.planes(0), .depth = layer.planes(1)};
      absl::StatusOr<DepthSamples> samples =
          readDepthSamples(found.depth, *frame.wire.planes[plane_index + 1], source.camera());
      if (!samples.ok()) {
        return withFieldPrefix(samples.status(), strCat("sources[", sources.size() - 1, "]"));
      }
      found.samples = *std::move(samples);
      found.measures = measureDepth(found.samples);
      const uint32_t code_max =
          layer_index < frame.code_max.size() ? frame.code_max[layer_index] : 0;
      found.suspicions =
          suspectDepth({found.depth, code_max, found.samples, found.measures, source.cube_map()});
      const auto add = [&found](const std::vector<Suspicion>& suspicions) {
        found.suspicions.insert(found.suspicions.end(), suspicions.begin(), suspicions.end());
      };
      // Behind the first layer, colour may well be transparent.
      if (source.layers_size() == 1) {
        add(suspectAlpha(found.color, measureAlpha(found.color, *frame.wire.planes[plane_index],
                                                   found.samples)));
      }
      add(suspectShapes(found.color.size(), found.depth.size()));
      inspected.layers.push_back(std::move(found));
      plane_index += 2;
      ++layer_index;
    }
  }
  return sources;
}

absl::StatusOr<InspectionPicture> drawInspection(const LayerInspection& layer,
                                                 const std::vector<uint8_t>& color_bytes) {
  v1::Plane color = layer.color;
  std::vector<uint8_t> decoded;
  if (color.encoding() == v1::PLANE_ENCODING_JPEG) {
    absl::StatusOr<files::Picture> picture = files::decodeJpeg("colour", color_bytes);
    if (!picture.ok()) return picture.status();
    decoded = std::move(picture->bytes);
    color.set_encoding(v1::PLANE_ENCODING_RGB8);
  }
  const ColorPixels pixels(color, decoded.empty() ? color_bytes : decoded);
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
          pixels.at((x * stride + 0.5) / samples.width_px, (y * stride + 0.5) / samples.height_px);
      const Rgb right = depthColor(samples.inv_z[index], layer.measures);
      uint8_t* const row = &picture.rgb[size_t{3} * y * picture.width_px];
      std::copy(left.begin(), left.end(), row + size_t{3} * x);
      std::copy(right.begin(), right.end(), row + size_t{3} * (half_px + x));
    }
  }
  return picture;
}

}  // namespace viewloom::inspect
