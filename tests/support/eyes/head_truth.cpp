// SPDX-License-Identifier: Apache-2.0
#include "support/eyes/head_truth.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "scoring/psnr.h"
#include "support/srgb_transfer.h"
#include "support/truth/known.h"
#include "support/truth/picture_frame.h"

namespace viewloom::test {
namespace {

constexpr double kDepthOff = 0.01;

// The rows of a plane, its bands joined.
std::vector<uint8_t> planeOf(const EncodedAtlas& atlas, AtlasPlane plane) {
  std::vector<uint8_t> bytes;
  for (const EncodedBand& band : atlas.bands) {
    if (band.plane != plane) continue;
    VIEWLOOM_CHECK(band.encoding == BandEncoding::kRaw);
    bytes.insert(bytes.end(), band.bytes->begin(), band.bytes->end());
  }
  return bytes;
}

// A view as it was served, px by px.
class ServedView {
 public:
  ServedView(const EncodedAtlas& atlas, uint32_t view)
      : width_px_(atlas.layout->size_px.width),
        origin_(atlas.layout->tileOrigin(view)),
        color_(planeOf(atlas, AtlasPlane::kColor)),
        depth_(planeOf(atlas, AtlasPlane::kDepth)),
        mask_(planeOf(atlas, AtlasPlane::kMask)) {}

  double srgb(uint32_t x, uint32_t y, int channel) const {
    return color_.at(3 * at(x, y) + size_t(channel)) / 255.0;
  }
  double invZ(uint32_t x, uint32_t y) const {
    float inv_z = 0;
    std::memcpy(&inv_z, &depth_.at(sizeof(float) * at(x, y)), sizeof inv_z);
    return double{inv_z};
  }
  RayClass rayClass(uint32_t x, uint32_t y) const { return RayClass(mask_.at(at(x, y))); }

 private:
  size_t at(uint32_t x, uint32_t y) const {
    return size_t{origin_.y_px + y} * width_px_ + origin_.x_px + x;
  }

  const uint32_t width_px_;
  const TileOrigin origin_;
  const std::vector<uint8_t> color_;
  const std::vector<uint8_t> depth_;
  const std::vector<uint8_t> mask_;
};

// The px and its neighbours see one body alone, and the same, and are known alike.
bool isInside(const truth::Picture& picture, const std::vector<uint8_t>& known, uint32_t x,
              uint32_t y) {
  const auto [width, height] = picture.size_px;
  if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) return false;
  const std::vector<uint32_t>& body = picture.layers.front().body;
  const size_t px = size_t{y} * width + x;
  for (size_t i = 0; i < 9; ++i) {
    const size_t other = px + i % 3 - 1 + (i / 3) * width - width;
    if (body[other] != body[px] || known[other] != known[px]) return false;
  }
  return true;
}

glm::dvec3 errorsOf(const ServedView& view, const glm::vec3& linear, uint32_t x, uint32_t y) {
  glm::dvec3 errors;
  for (int c = 0; c < 3; ++c) errors[c] = view.srgb(x, y, c) - srgbFrom(double{linear[c]});
  return errors;
}

void add(const glm::dvec3& errors, Psnr& psnr) {
  for (int c = 0; c < 3; ++c) psnr.add(errors[c]);
}

}  // namespace

HeadTruth::HeadTruth(const truth::Scene& scene, SizePx source_px, double focal_px,
                     uint32_t layer_count)
    : instant_(scene, 0),
      source_{.pose = {},
              .intrinsics = {glm::dvec2(focal_px),
                             0.5 * glm::dvec2(source_px.width, source_px.height)}},
      source_px_(source_px),
      layer_count_(layer_count) {}

FramePtr HeadTruth::frame() const {
  truth::Picture picture =
      truth::takePicture(instant_, source_, {.size_px = source_px_, .layer_count = layer_count_});
  // Eyes are scored beside this instant, however late they look.
  for (truth::PictureLayer& layer : picture.layers) {
    std::fill(layer.motion_mps.begin(), layer.motion_mps.end(), glm::vec3(0));
  }
  return truth::frameOf(picture, layer_count_);
}

TrueEye HeadTruth::seenBy(const Camera& eye, SizePx eye_px) const {
  return {
      truth::takePicture(instant_, eye, {.size_px = eye_px, .color = truth::ColorOver::kCenter}),
      truth::knownFrom(instant_, source_, source_px_, eye, eye_px), layer_count_};
}

EyeScore TrueEye::score(const EncodedAtlas& atlas, size_t view_index) const {
  const SizePx size_px = picture_.size_px;
  const ServedView view(atlas, uint32_t(view_index));
  const truth::PictureLayer& seen = picture_.layers.front();
  Psnr inside, of_known, full;
  uint64_t inside_count = 0, depth_off_count = 0, outside_count = 0, outside_differs_count = 0;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const size_t px = size_t{y} * size_px.width + x;
      const bool is_known = known_[px] < layer_count_;
      const bool is_inside = isInside(picture_, known_, x, y);
      const bool is_outside = known_[px] == truth::kOutside;
      const glm::dvec3 errors = errorsOf(view, seen.color[px], x, y);
      add(errors, full);
      outside_count += is_outside;
      if (is_inside && (is_known || is_outside)) {
        outside_differs_count += is_outside != (view.rayClass(x, y) == RayClass::kOutside);
      }
      if (!is_known) continue;
      add(errors, of_known);
      if (!is_inside) continue;
      add(errors, inside);
      ++inside_count;
      const double true_inv_z = 1 / double{seen.depth_m[px]};
      depth_off_count += std::abs(view.invZ(x, y) - true_inv_z) > kDepthOff * true_inv_z;
    }
  }
  const auto area = double(size_px.area());
  return {.inside_db = inside.db(),
          .known_db = of_known.db(),
          .full_db = full.db(),
          .depth_off_share = inside_count == 0 ? 0 : double(depth_off_count) / double(inside_count),
          .outside_share = double(outside_count) / area,
          .outside_differs_share = double(outside_differs_count) / area};
}

Fov fovOf(SizePx source_px, double focal_px) {
  const double right_rad = std::atan(0.5 * source_px.width / focal_px);
  const double up_rad = std::atan(0.5 * source_px.height / focal_px);
  return {.left_rad = -right_rad, .right_rad = right_rad, .up_rad = up_rad, .down_rad = -up_rad};
}

}  // namespace viewloom::test
