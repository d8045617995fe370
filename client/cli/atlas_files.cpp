// SPDX-License-Identifier: Apache-2.0
#include "cli/atlas_files.h"

#include <turbojpeg.h>

#include <cstdio>
#include <memory>

#include "files/file_bytes.h"
#include "files/png_writer.h"

namespace viewloom::cli {
namespace {

constexpr int kViewJpegQuality = 95;  // of pictures decoded once already: keep what is left

std::string padded(uint64_t number, int digits) {
  char text[32];
  std::snprintf(text, sizeof(text), "%0*llu", digits, static_cast<unsigned long long>(number));
  return text;
}

absl::StatusOr<std::string> encodeJpeg(const AtlasPicture& picture) {
  const std::unique_ptr<void, int (*)(void*)> handle(tjInitCompress(), &tjDestroy);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(
      handle.get(), picture.samples.data(), static_cast<int>(picture.width_px), 0,
      static_cast<int>(picture.height_px), TJPF_RGB, &out, &size, TJSAMP_444, kViewJpegQuality, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owned(out, &tjFree);
  if (failed != 0) return absl::InternalError(tjGetErrorStr2(handle.get()));
  return std::string(reinterpret_cast<const char*>(out), size);
}

absl::Status writePicture(const AtlasPicture& picture, bool as_png,
                          const std::filesystem::path& stem) {
  const absl::StatusOr<std::string> bytes =
      as_png
          ? files::encodePng(picture.samples, picture.width_px, picture.height_px, picture.channels)
          : encodeJpeg(picture);
  if (!bytes.ok()) return bytes.status();
  return files::writeFileWhole(stem.string() + (as_png ? ".png" : ".jpg"), *bytes);
}

// Samples of 16 bits, RGB: colour, and to the right of it the codes as grey.
std::vector<uint16_t> besideEachOther(const AtlasPicture& color, const AtlasPicture& codes) {
  constexpr uint16_t kFrom8Bits = 257;  // 255 becomes 65535
  std::vector<uint16_t> samples;
  samples.reserve(size_t{6} * color.width_px * color.height_px);
  for (size_t y = 0; y < color.height_px; ++y) {
    const uint8_t* const rgb = &color.samples[y * color.width_px * 3];
    for (size_t i = 0; i < size_t{3} * color.width_px; ++i) {
      samples.push_back(uint16_t(rgb[i] * kFrom8Bits));
    }
    const uint8_t* const bytes = &codes.samples[y * codes.width_px * 2];
    for (size_t x = 0; x < codes.width_px; ++x) {
      samples.insert(samples.end(), 3, uint16_t(bytes[2 * x] | bytes[2 * x + 1] << 8));
    }
  }
  return samples;
}

absl::Status writeWithDepth(const AtlasPicture& color, const AtlasPicture& codes,
                            const std::filesystem::path& stem) {
  const absl::StatusOr<std::string> png =
      files::encodePng16(besideEachOther(color, codes), 2 * color.width_px, color.height_px);
  if (!png.ok()) return png.status();
  return files::writeFileWhole(stem.string() + ".png", *png);
}

// Colour whose depth comes as a plane of its own.
absl::Status writeDepthCodes(const Atlas& atlas, const AtlasFileOptions& options,
                             const std::filesystem::path& stem) {
  const absl::StatusOr<AtlasPicture> color = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  if (!color.ok()) return color.status();
  const absl::StatusOr<AtlasPicture> codes = decodePlane(atlas, v1::ATLAS_PLANE_DEPTH_CODES);
  if (!codes.ok()) return codes.status();
  if (!options.writes_views) return writeWithDepth(*color, *codes, stem.string() + "_rgbd");
  for (uint32_t view = 0; view < atlas.layout->view_count(); ++view) {
    VIEWLOOM_RETURN_IF_ERROR(writeWithDepth(cutView(*color, *atlas.layout, view),
                                            cutView(*codes, *atlas.layout, view),
                                            stem.string() + "_view" + padded(view, 3) + "_rgbd"));
  }
  return absl::OkStatus();
}

absl::Status writeColor(const Atlas& atlas, const AtlasFileOptions& options,
                        const std::filesystem::path& stem) {
  if (atlas.layout->depth_codes().bits() == 16) return writeDepthCodes(atlas, options, stem);
  const char* const kind = atlas.layout->has_depth_codes() ? "_rgbd" : "";
  const std::string whole = stem.string() + atlas.layout->suffix() + kind;
  const bool is_jpeg = atlas.layout->encoding().color() == v1::BAND_ENCODING_JPEG;
  if (is_jpeg && !options.writes_views && !options.writes_png) {
    const absl::StatusOr<std::string> jpeg = joinJpegBands(atlas);
    if (!jpeg.ok()) return jpeg.status();
    return files::writeFileWhole(whole + ".jpg", *jpeg);
  }
  const absl::StatusOr<AtlasPicture> picture = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  if (!picture.ok()) return picture.status();
  // What neighbouring subpixels of a panel show to different eyes no usual JPEG keeps apart.
  // Panels are the displays with a cone whose picture is one view, not a quilt.
  const bool is_panel = atlas.layout->view_cone_rad() > 0 && atlas.layout->suffix().empty();
  if (!options.writes_views) return writePicture(*picture, options.writes_png || is_panel, whole);
  for (uint32_t view = 0; view < atlas.layout->view_count(); ++view) {
    VIEWLOOM_RETURN_IF_ERROR(writePicture(cutView(*picture, *atlas.layout, view),
                                          options.writes_png,
                                          stem.string() + "_view" + padded(view, 3)));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status writeAtlas(const Atlas& atlas, const AtlasFileOptions& options) {
  const std::filesystem::path stem =
      options.folder / (options.stream + "_" + padded(atlas.header.frame_number(), 6) + "_" +
                        padded(atlas.header.sequence(), 6));
  VIEWLOOM_RETURN_IF_ERROR(writeColor(atlas, options, stem));
  if (!atlas.layout->encoding().with_mask()) return absl::OkStatus();
  const absl::StatusOr<AtlasPicture> mask = decodePlane(atlas, v1::ATLAS_PLANE_MASK);
  if (!mask.ok()) return mask.status();
  return writePicture(*mask, true, stem.string() + atlas.layout->suffix() + "_mask");
}

}  // namespace viewloom::cli
