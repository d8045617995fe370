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

absl::Status writeColor(const Atlas& atlas, const AtlasFileOptions& options,
                        const std::filesystem::path& stem) {
  const std::string whole = stem.string() + atlas.layout->suffix();
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
