// SPDX-License-Identifier: Apache-2.0
#include "files/png_image.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// One libpng reading. libpng reports errors by longjmp: each method that calls it sets its own
// landing place and keeps no object alive across it.
class PngReader {
 public:
  explicit PngReader(const std::filesystem::path& path)
      : file_(std::fopen(path.c_str(), "rb"), &std::fclose),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::onError, &onWarning)),
        info_(png_create_info_struct(png_)) {}
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  const std::string& error() const { return error_; }
  uint32_t width() const { return png_get_image_width(png_, info_); }
  uint32_t height() const { return png_get_image_height(png_, info_); }
  uint32_t channels() const { return png_get_channels(png_, info_); }
  uint32_t bitDepth() const { return png_get_bit_depth(png_, info_); }
  size_t rowBytes() const { return png_get_rowbytes(png_, info_); }

  bool readHeader() {
    if (file_ == nullptr) {
      error_ = "cannot be opened";
      return false;
    }
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_user_limits(png_, static_cast<png_uint_32>(kSideMax_px),
                        static_cast<png_uint_32>(kSideMax_px));
    png_init_io(png_, file_.get());
    png_read_info(png_, info_);
    return true;
  }

  // From here on samples are 8 or 16 bits (little endian), and colour is RGB or RGBA.
  bool expand(PngUse use) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand(png_);
    if (use == PngUse::kColor) png_set_gray_to_rgb(png_);
    png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool readRows(png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    static_cast<PngReader*>(png_get_error_ptr(png))->error_ = message;
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}  // odd ancillary chunks change no sample

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  png_structp png_;
  png_infop info_;
  std::string error_;
};

}  // namespace

absl::StatusOr<Picture> readPng(const std::filesystem::path& path, PngUse use) {
  VIEWLOOM_RETURN_IF_ERROR(checkFile(path));
  PngReader reader(path);
  const auto refusal = [&] { return refuseFile(path.string(), "PNG: " + reader.error()); };
  if (!reader.readHeader()) return refusal();
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path.string(), reader.width(), reader.height()));
  if (use == PngUse::kDepth && reader.bitDepth() < 8) {
    return refuseFile(path.string(), absl::StrCat("has samples of ", reader.bitDepth(),
                                                  " bits; accepted as depth is grey of 8 or 16"));
  }
  if (!reader.expand(use)) return refusal();
  Picture picture{.width_px = reader.width(),
                  .height_px = reader.height(),
                  .channels = reader.channels(),
                  .bits = reader.bitDepth(),
                  .bytes = std::vector<uint8_t>(reader.rowBytes() * reader.height())};
  std::vector<png_bytep> rows(picture.height_px);
  for (size_t y = 0; y < rows.size(); ++y) rows[y] = &picture.bytes[y * reader.rowBytes()];
  if (!reader.readRows(rows.data())) return refusal();
  return picture;
}

absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples) {
  absl::StatusOr<Picture> picture = readPng(path, PngUse::kColor);
  if (!picture.ok()) return picture.status();
  return colorPlane(*std::move(picture), linear_samples);
}

absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread) {
  const absl::StatusOr<Picture> picture = readPng(path, PngUse::kDepth);
  if (!picture.ok()) return picture.status();
  return depthPlane(path.string(), *picture, spread);
}

}  // namespace viewloom::files
