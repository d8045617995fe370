// SPDX-License-Identifier: Apache-2.0
#include "inputs/panorama.h"

#include <Imath/half.h>
#include <OpenEXR/ImfEnvmap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/jpeg_image.h"
#include "files/plane_image.h"

namespace viewloom::inputs {
namespace {

constexpr uint32_t kFaceCount = 6;

// Faces as proto Source.cube_map orders them: where they look, and what is to the right and up.
struct Face {
  glm::dvec3 forward, right, up;
};
constexpr std::array<Face, kFaceCount> kFaces{{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                               {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                               {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                               {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                               {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                                               {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}};

// Where a panorama has a direction, in px from its upper left corner.
class Lookup {
 public:
  Lookup(Projection projection, double width_px, double height_px)
      : is_cube_(projection == Projection::kCube), width_(width_px), height_(height_px) {}

  glm::dvec2 at(const glm::dvec3& direction) const {
    return is_cube_ ? inCube(direction) : inEquirect(direction);
  }
  bool wraps() const { return !is_cube_; }

 private:
  glm::dvec2 inEquirect(const glm::dvec3& direction) const {
    const double longitude = std::atan2(direction.x, -direction.z);  // 0 ahead, to the right
    const double latitude = std::asin(std::clamp(direction.y / glm::length(direction), -1.0, 1.0));
    return {(0.5 + longitude / (2 * std::numbers::pi)) * width_,
            (0.5 - latitude / std::numbers::pi) * height_};
  }

  // OpenEXR's cube looks ahead along +z: the same, half a turn about y.
  glm::dvec2 inCube(const glm::dvec3& direction) const {
    const int side = static_cast<int>(width_);
    const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(side - 1, 6 * side - 1));
    Imf::CubeMapFace face{};
    Imath::V2f in_face;
    Imf::CubeMap::faceAndPixelPosition(
        Imath::V3f(float(-direction.x), float(direction.y), float(-direction.z)), window, face,
        in_face);
    const Imath::V2f at = Imf::CubeMap::pixelPosition(face, window, in_face);
    // Its px centres are whole numbers; faces do not mix.
    return {std::round(double{at.x}) + 0.5, std::round(double{at.y}) + 0.5};
  }

  bool is_cube_;
  double width_, height_;
};

// Channels of a px, and a mix of four of them.
class ColorSampler {
 public:
  ColorSampler(const v1::Plane& plane, const std::vector<uint8_t>& bytes, bool wraps)
      : bytes_(bytes),
        width_(int(plane.size().width())),
        height_(int(plane.size().height())),
        is_half_(plane.encoding() == v1::PLANE_ENCODING_RGBA16F),
        stored_(plane.encoding() == v1::PLANE_ENCODING_RGB8 ? 3 : 4),
        wraps_(wraps) {}

  size_t pixelBytes() const { return is_half_ ? 8 : 3; }

  void sample(const glm::dvec2& at, uint8_t* to) const {
    const double x = at.x - 0.5, y = at.y - 0.5;
    const int left = int(std::floor(x)), top = int(std::floor(y));
    const auto right = float(x - left), down = float(y - top);
    for (int channel = 0; channel < 3; ++channel) {
      const float above =
          (1 - right) * value(left, top, channel) + right * value(left + 1, top, channel);
      const float below =
          (1 - right) * value(left, top + 1, channel) + right * value(left + 1, top + 1, channel);
      put(to, channel, (1 - down) * above + down * below);
    }
    if (is_half_) put(to, 3, 1);
  }

 private:
  float value(int x, int y, int channel) const {
    const int column = wraps_ ? (x % width_ + width_) % width_ : std::clamp(x, 0, width_ - 1);
    const int row = std::clamp(y, 0, height_ - 1);
    const size_t index =
        (size_t(row) * size_t(width_) + size_t(column)) * size_t(stored_) + size_t(channel);
    if (!is_half_) return bytes_[index];
    uint16_t bits = 0;
    std::memcpy(&bits, &bytes_[2 * index], sizeof bits);
    return Imath::half(Imath::half::FromBits, bits);
  }

  void put(uint8_t* to, int channel, float value) const {
    if (is_half_) {
      const uint16_t bits = Imath::half(value).bits();
      std::memcpy(to + 2 * channel, &bits, sizeof bits);
    } else {
      to[channel] = static_cast<uint8_t>(std::lround(value));
    }
  }

  const std::vector<uint8_t>& bytes_;
  int width_, height_;
  bool is_half_;
  int stored_;
  bool wraps_;
};

// Metres, or 1/m of a disparity, NaN without surface, at a px.
class DepthSampler {
 public:
  DepthSampler(const v1::Plane& plane, const std::vector<uint8_t>& bytes)
      : plane_(plane),
        format_(plane.depth()),
        bytes_(bytes),
        is_disparity_(format_.meaning() == v1::DEPTH_MEANING_DISPARITY),
        scale_(format_.scale() == 0 ? 1 : format_.scale()) {}

  float at(const glm::dvec2& place) const {
    const auto clamped = [](double value, uint32_t count) {
      return size_t(std::clamp(std::floor(value), 0.0, double(count) - 1));
    };
    const size_t index = clamped(place.y, plane_.size().height()) * plane_.size().width() +
                         clamped(place.x, plane_.size().width());
    const float stored = storedAt(index);
    if (format_.has_invalid_value() && stored == rounded(format_.invalid_value())) {
      if (!format_.invalid_is_far()) return std::numeric_limits<float>::quiet_NaN();
      return is_disparity_ ? 0 : std::numeric_limits<float>::infinity();
    }
    const double value = double{stored} * scale_ + format_.offset();
    const bool is_none = is_disparity_ ? !(value >= 0) : !(value > 0);
    return is_none ? std::numeric_limits<float>::quiet_NaN() : float(value);
  }

 private:
  float rounded(double value) const {
    return plane_.encoding() == v1::PLANE_ENCODING_DEPTH_F16
               ? float{Imath::half(static_cast<float>(value))}
               : static_cast<float>(value);
  }

  float storedAt(size_t index) const {
    if (plane_.encoding() == v1::PLANE_ENCODING_DEPTH_F32) {
      float sample = 0;
      std::memcpy(&sample, &bytes_[4 * index], sizeof sample);
      return sample;
    }
    uint16_t bits = 0;
    std::memcpy(&bits, &bytes_[2 * index], sizeof bits);
    if (plane_.encoding() == v1::PLANE_ENCODING_DEPTH_U16) return bits;
    return Imath::half(Imath::half::FromBits, bits);
  }

  const v1::Plane& plane_;
  const v1::DepthFormat& format_;
  const std::vector<uint8_t>& bytes_;
  bool is_disparity_;
  double scale_;
};

absl::Status check(const std::string& file, Projection projection, const v1::Layer& layer) {
  const v1::SizePx& size = layer.planes(1).size();
  if (layer.planes(1).depth().meaning() == v1::DEPTH_MEANING_WINDOW) {
    return files::refuseFile(
        file, "is a panorama with graphics depth; accepted are --depth-meaning ray and disparity");
  }
  for (const v1::Plane& plane : layer.planes()) {
    if (projection != Projection::kCube) break;
    if (plane.size().height() == 6 * plane.size().width() && size.width() == plane.size().width()) {
      continue;
    }
    return files::refuseFile(
        file, strCat("is a cube map of ", plane.size().width(), "x", plane.size().height(),
                     " px; accepted are six square faces, one below "
                     "the other, colour and depth alike"));
  }
  return absl::OkStatus();
}

uint32_t faceSide(Projection projection, const v1::Layer& layer) {
  const uint32_t width = std::max(layer.planes(0).size().width(), layer.planes(1).size().width());
  if (projection == Projection::kCube) return width;
  return std::max(1U, uint32_t(std::lround(width / std::numbers::pi)));
}

// Calls take(direction, index) for every px of the six faces; direction: one along the face's axis.
template <typename Take>
void forEachDirection(uint32_t side, const Take& take) {
  size_t index = 0;
  for (const Face& face : kFaces) {
    for (uint32_t y = 0; y < side; ++y) {
      for (uint32_t x = 0; x < side; ++x, ++index) {
        const double right = (x + 0.5) / side * 2 - 1, up = 1 - (y + 0.5) / side * 2;
        take(face.forward + right * face.right + up * face.up, index);
      }
    }
  }
}

void describe(uint32_t side, const std::vector<uint8_t>& bytes, v1::Plane& plane) {
  plane.mutable_size()->set_width(side);
  plane.mutable_size()->set_height(kFaceCount * side);
  plane.set_bytes_count(bytes.size());
}

void convertColor(Projection projection, uint32_t side, v1::Plane& plane, SharedBytes& bytes) {
  const Lookup lookup(projection, plane.size().width(), plane.size().height());
  const ColorSampler sampler(plane, *bytes, lookup.wraps());
  std::vector<uint8_t> faces(sampler.pixelBytes() * kFaceCount * side * side);
  forEachDirection(side, [&](const glm::dvec3& direction, size_t index) {
    sampler.sample(lookup.at(direction), &faces[sampler.pixelBytes() * index]);
  });
  describe(side, faces, plane);
  if (plane.encoding() != v1::PLANE_ENCODING_RGBA16F) plane.set_encoding(v1::PLANE_ENCODING_RGB8);
  plane.set_alpha(v1::ALPHA_MODE_OPAQUE);
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(faces));
}

void convertDepth(Projection projection, uint32_t side, v1::Plane& plane, SharedBytes& bytes) {
  const Lookup lookup(projection, plane.size().width(), plane.size().height());
  const DepthSampler sampler(plane, *bytes);
  const bool is_disparity = plane.depth().meaning() == v1::DEPTH_MEANING_DISPARITY;
  const bool is_along_ray = projection == Projection::kEquirect ||
                            plane.depth().meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
  std::vector<uint8_t> faces(sizeof(float) * kFaceCount * side * side);
  forEachDirection(side, [&](const glm::dvec3& direction, size_t index) {
    // Length of the ray per metre along the face's axis.
    const double length = is_along_ray ? glm::length(direction) : 1;
    const float value = sampler.at(lookup.at(direction));
    const auto along_axis = float(is_disparity ? value * length : value / length);
    std::memcpy(&faces[sizeof(float) * index], &along_axis, sizeof along_axis);
  });
  describe(side, faces, plane);
  plane.set_encoding(v1::PLANE_ENCODING_DEPTH_F32);
  v1::DepthFormat format;
  format.set_meaning(is_disparity ? v1::DEPTH_MEANING_DISPARITY : v1::DEPTH_MEANING_PLANAR);
  *plane.mutable_depth() = format;
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(faces));
}

// Colour that is still compressed is unpacked.
absl::Status unpackColor(const std::string& file, v1::Plane& plane, SharedBytes& bytes) {
  if (plane.encoding() != v1::PLANE_ENCODING_JPEG) return absl::OkStatus();
  absl::StatusOr<files::Picture> picture = files::decodeJpeg(file, *bytes);
  if (!picture.ok()) return picture.status();
  files::PlaneImage image = files::colorPlane(*std::move(picture), v1::COLOR_TRANSFER_SRGB);
  plane.set_encoding(image.encoding);
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(image.bytes));
  return absl::OkStatus();
}

}  // namespace

absl::Status makeCubeMap(const std::string& file, Projection projection,
                         files::LoadedFrame& loaded) {
  WireFrame& frame = loaded.wire;
  v1::Source& source = *frame.header.mutable_sources(0);
  v1::Layer& layer = *source.mutable_layers(0);
  VIEWLOOM_RETURN_IF_ERROR(check(file, projection, layer));
  VIEWLOOM_RETURN_IF_ERROR(unpackColor(file, *layer.mutable_planes(0), frame.planes[0]));
  const uint32_t side = faceSide(projection, layer);
  convertColor(projection, side, *layer.mutable_planes(0), frame.planes[0]);
  convertDepth(projection, side, *layer.mutable_planes(1), frame.planes[1]);
  source.set_cube_map(true);
  return absl::OkStatus();
}

}  // namespace viewloom::inputs
