// SPDX-License-Identifier: Apache-2.0
#include "offline/truth_image.h"

#include <cstring>

#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>

#include "base/str_cat.h"
#include "decode/jpeg_plane.h"
#include "files/file_bytes.h"
#include "files/plane_file.h"
#include "files/png_image.h"

namespace viewloom {
namespace {

// Samples of a plane as numbers in 0..1, still in the plane's own transfer; alpha 1 where it has
// none.
std::vector<glm::vec4> unpackSamples(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  std::vector<glm::vec4> samples(size_t{plane.size().width()} * plane.size().height());
  for (size_t i = 0; i < samples.size(); ++i) {
    if (plane.encoding() == v1::PLANE_ENCODING_RGBA16F) {
      uint64_t packed = 0;
      std::memcpy(&packed, &bytes[8 * i], sizeof packed);
      samples[i] = glm::unpackHalf4x16(packed);
    } else {
      const bool has_fourth = plane.encoding() != v1::PLANE_ENCODING_RGB8;
      const uint8_t* px = &bytes[(has_fourth ? 4 : 3) * i];
      samples[i] = glm::vec4(px[0], px[1], px[2], has_fourth ? px[3] : 255) / 255.0F;
    }
  }
  return samples;
}

// One sample on black, sRGB-encoded.
float onBlack(float sample, float alpha, const v1::Plane& plane) {
  const bool is_linear = plane.transfer() == v1::COLOR_TRANSFER_LINEAR;
  const bool is_straight = plane.alpha() == v1::ALPHA_MODE_STRAIGHT;
  if (!is_linear && !is_straight) return sample;
  const double linear = is_linear ? double{sample} : linearFromSrgb(sample);
  return static_cast<float>(srgbFromLinear(is_straight ? linear * alpha : linear));
}

}  // namespace

absl::StatusOr<ScoredImage> loadScoredImage(const v1::PlaneFile& file,
                                            const std::filesystem::path& folder,
                                            ScoreTransfer transfer) {
  absl::StatusOr<files::LoadedPlane> loaded = files::loadColorPlane(file, folder);
  if (!loaded.ok()) return loaded.status();
  const v1::Plane& plane = loaded->plane;
  if (plane.primaries() != v1::COLOR_PRIMARIES_UNSPECIFIED &&
      plane.primaries() != v1::COLOR_PRIMARIES_BT709) {
    return invalidField("primaries",
                        "a true picture is scored in BT709, which is what is accepted");
  }
  ScoredImage image = {.size_px = {plane.size().width(), plane.size().height()}, .rgb = {}};
  std::vector<uint8_t> decoded;
  if (plane.encoding() == v1::PLANE_ENCODING_JPEG) {
    VIEWLOOM_RETURN_IF_ERROR(JpegDecoder().decode(*loaded->bytes, image.size_px, decoded));
  }
  image.rgb.reserve(3 * image.size_px.area());
  for (const glm::vec4& px : unpackSamples(plane, decoded.empty() ? *loaded->bytes : decoded)) {
    for (int c = 0; c < 3; ++c) {
      image.rgb.push_back(scoredSample(onBlack(px[c], px.a, plane), transfer));
    }
  }
  return image;
}

absl::StatusOr<std::vector<PixelClass>> loadCoveredMask(const std::filesystem::path& path,
                                                        SizePx size_px) {
  const auto png = files::readPngDepth(path, false);
  if (!png.ok()) return png.status();
  if (SizePx{png->width_px, png->height_px} != size_px) {
    return files::refuseFile(path.string(), strCat("is ", png->width_px, "x", png->height_px,
                                                   " px; accepted is the size of the view, ",
                                                   size_px.width, "x", size_px.height));
  }
  std::vector<PixelClass> classes(size_px.area());
  for (size_t i = 0; i < classes.size(); ++i) {
    uint16_t grey = 0;
    std::memcpy(&grey, &png->bytes[2 * i], sizeof grey);
    classes[i] = grey == 0     ? PixelClass::kHidden
                 : grey >= 255 ? PixelClass::kCovered
                               : PixelClass::kOutside;
  }
  return classes;
}

}  // namespace viewloom
