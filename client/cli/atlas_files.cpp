// SPDX-License-Identifier: Apache-2.0
#include "cli/atlas_files.h"

#include <turbojpeg.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/png_image.h"
#include "lib/file_name_part.h"

namespace viewloom::cli {
namespace {

constexpr uint64_t kRunMax = 1'000'000'000;
constexpr int kViewJpegQuality = 95;  // of pictures decoded once already: keep what is left

std::string padded(uint64_t number, int digits) {
  char text[32];
  std::snprintf(text, sizeof(text), "%0*llu", digits, static_cast<unsigned long long>(number));
  return text;
}

std::string viewEnding(uint32_t view) {
  return "_view" + padded(view, 3);
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

// Saves a file whose name ends so. ALREADY_EXISTS when there is one.
using Save = std::function<absl::Status(const std::string& ending, std::string_view bytes)>;

// Colour of the atlas, decoded when it is asked for first.
using GetColor = std::function<const absl::StatusOr<AtlasPicture>&()>;

absl::Status writePicture(const AtlasPicture& picture, bool as_png, const std::string& ending,
                          const Save& save) {
  const absl::StatusOr<std::string> bytes =
      as_png
          ? files::encodePng(picture.samples, picture.width_px, picture.height_px, picture.channels)
          : encodeJpeg(picture);
  if (!bytes.ok()) return bytes.status();
  return save(ending + (as_png ? ".png" : ".jpg"), *bytes);
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
                            const std::string& ending, const Save& save) {
  const absl::StatusOr<std::string> png =
      files::encodePng16(besideEachOther(color, codes), 2 * color.width_px, color.height_px);
  if (!png.ok()) return png.status();
  return save(ending + ".png", *png);
}

// Colour whose depth comes as a plane of its own.
absl::Status writeDepthCodes(const Atlas& atlas, const AtlasFileOptions& options,
                             const Save& save) {
  const absl::StatusOr<AtlasPicture> color = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  if (!color.ok()) return color.status();
  const absl::StatusOr<AtlasPicture> codes = decodePlane(atlas, v1::ATLAS_PLANE_DEPTH_CODES);
  if (!codes.ok()) return codes.status();
  if (!options.writes_views) return writeWithDepth(*color, *codes, "_rgbd", save);
  for (uint32_t view = 0; view < atlas.layout->view_count(); ++view) {
    VIEWLOOM_RETURN_IF_ERROR(writeWithDepth(cutView(*color, *atlas.layout, view),
                                            cutView(*codes, *atlas.layout, view),
                                            viewEnding(view) + "_rgbd", save));
  }
  return absl::OkStatus();
}

absl::Status writeColor(const Atlas& atlas, const AtlasFileOptions& options, const GetColor& color,
                        const Save& save) {
  if (atlas.layout->depth_codes().bits() == 16) return writeDepthCodes(atlas, options, save);
  const char* const kind = atlas.layout->has_depth_codes() ? "_rgbd" : "";
  const std::string whole = atlas.layout->suffix() + kind;
  const bool is_jpeg = atlas.layout->encoding().color() == v1::BAND_ENCODING_JPEG;
  if (is_jpeg && !options.writes_views && !options.writes_png) {
    const absl::StatusOr<std::string> jpeg = joinJpegBands(atlas);
    if (!jpeg.ok()) return jpeg.status();
    return save(whole + ".jpg", *jpeg);
  }
  const absl::StatusOr<AtlasPicture>& picture = color();
  if (!picture.ok()) return picture.status();
  // No usual JPEG keeps neighbouring subpixels of a panel apart, which different eyes see. Panels
  // are the displays with a cone whose picture is one view, not a quilt.
  const bool is_panel = atlas.layout->view_cone_rad() > 0 && atlas.layout->suffix().empty();
  if (!options.writes_views)
    return writePicture(*picture, options.writes_png || is_panel, whole, save);
  for (uint32_t view = 0; view < atlas.layout->view_count(); ++view) {
    VIEWLOOM_RETURN_IF_ERROR(writePicture(cutView(*picture, *atlas.layout, view),
                                          options.writes_png, viewEnding(view), save));
  }
  return absl::OkStatus();
}

absl::Status writeAtlas(const Atlas& atlas, const AtlasFileOptions& options, const GetColor& color,
                        const Save& save) {
  VIEWLOOM_RETURN_IF_ERROR(writeColor(atlas, options, color, save));
  if (!atlas.layout->encoding().with_mask()) return absl::OkStatus();
  const absl::StatusOr<AtlasPicture> mask = decodePlane(atlas, v1::ATLAS_PLANE_MASK);
  if (!mask.ok()) return mask.status();
  return writePicture(*mask, true, atlas.layout->suffix() + "_mask", save);
}

// The run that a file belongs to, by the name of its stream; 0 = it is another's.
uint64_t runOf(std::string_view file, std::string_view stream) {
  if (!file.starts_with(stream) || file.size() <= stream.size() + 1) return 0;
  file.remove_prefix(stream.size());
  if (file[0] != '_') return 0;
  file.remove_prefix(1);
  if (file[0] >= '0' && file[0] <= '9') return 1;
  if (file[0] != 'r') return 0;
  uint64_t run = 0;
  const char* const end = file.data() + file.size();
  const auto [stop, error] = std::from_chars(file.data() + 1, end, run);
  const bool is_run = error == std::errc() && stop != end && *stop == '_' && run < kRunMax;
  return is_run ? run : 0;
}

// One more than any run whose files are in the folder.
uint64_t nextRun(const std::filesystem::path& folder, std::string_view stream) {
  uint64_t last = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    last = std::max(last, runOf(entry.path().filename().string(), stream));
  }
  return last + 1;
}

}  // namespace

AtlasFiles::AtlasFiles(AtlasFileOptions options)
    : options_(std::move(options)),
      name_(fileNameFrom(options_.stream)),
      run_(options_.folder.empty() ? 1 : nextRun(options_.folder, name_)) {}

std::filesystem::path AtlasFiles::stemOf(const v1::AtlasHeader& header) const {
  const std::string run = run_ == 1 ? "" : "_r" + std::to_string(run_);
  return options_.folder / (name_ + run + "_" + padded(header.frame_number(), 6) + "_" +
                            padded(header.sequence(), 6));
}

absl::StatusOr<AtlasFiles::Written> AtlasFiles::write(const Atlas& atlas) {
  if (!isFileNamePart(atlas.layout->suffix())) {
    return absl::FailedPreconditionError(
        "the server sent a name that cannot be part of a file name; nothing is saved");
  }
  // A server that was started again counts from the beginning.
  if (atlas.header.sequence() <= last_sequence_) ++run_;
  last_sequence_ = atlas.header.sequence();
  // Once, also where names are tried again: a decoder of chained video has gone on by then.
  std::optional<absl::StatusOr<AtlasPicture>> decoded;
  const GetColor color = [&]() -> const absl::StatusOr<AtlasPicture>& {
    if (!decoded) decoded.emplace(decoder_.decode(atlas));
    return *decoded;
  };
  for (;; ++run_) {
    Written written;
    const auto save = [&](const std::string& ending, std::string_view bytes) -> absl::Status {
      const std::filesystem::path path = stemOf(atlas.header).string() + ending;
      const absl::StatusOr<bool> is_new = files::writeNewFile(path, bytes);
      if (!is_new.ok()) return is_new.status();
      if (!*is_new) return absl::AlreadyExistsError(path.string());
      if (written.count++ == 0) written.first = path;
      return absl::OkStatus();
    };
    const absl::Status status = writeAtlas(atlas, options_, color, save);
    if (status.ok()) return written;
    // Somebody else writes the same names into the folder.
    if (!absl::IsAlreadyExists(status)) return status;
  }
}

absl::Status makeAtlasFolder(const std::filesystem::path& folder) {
  if (folder.empty()) return absl::OkStatus();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return absl::InvalidArgumentError(strCat("--out ", folder.string(),
                                             ": the folder cannot be created (", error.message(),
                                             "); accepted is a folder"));
  }
  if (access(folder.c_str(), W_OK | X_OK) == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat("--out ", folder.string(),
                                           ": no file can be written in this folder (",
                                           std::strerror(errno), ")"));
}

std::string describe(const AtlasFiles::Written& written) {
  const std::string first = written.first.string();
  if (written.count <= 1) return first;
  return first + " and " + std::to_string(written.count - 1) + " more";
}

}  // namespace viewloom::cli
