// SPDX-License-Identifier: Apache-2.0
#include "files/png_writer.h"

#include <png.h>

#include <csetjmp>
#include <utility>
#include <vector>

#include "base/check.h"

namespace viewloom::files {
namespace {

constexpr int kFastLevel = 1;  // of zlib

// One libpng writing. libpng reports errors by longjmp: write() keeps no object alive across it.
class PngWriter {
 public:
  PngWriter()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &PngWriter::onError, nullptr)),
        info_(png_create_info_struct(png_)) {}
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  // Rows of 16 bits RGB.
  bool write(png_bytep* rows, uint32_t width_px, uint32_t height_px) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_write_fn(png_, this, &PngWriter::onBytes, nullptr);
    png_set_compression_level(png_, kFastLevel);
    png_set_IHDR(png_, info_, width_px, height_px, 16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    png_set_swap(png_);  // ours are little endian
    png_write_image(png_, rows);
    png_write_end(png_, nullptr);
    return true;
  }

  const std::string& error() const { return error_; }
  std::string takeBytes() { return std::move(bytes_); }

 private:
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    static_cast<PngWriter*>(png_get_error_ptr(png))->error_ = message;
    png_longjmp(png, 1);
  }
  static void onBytes(png_structp png, png_bytep bytes, size_t count) {
    auto* const writer = static_cast<PngWriter*>(png_get_io_ptr(png));
    writer->bytes_.append(reinterpret_cast<const char*>(bytes), count);
  }

  png_structp png_;
  png_infop info_;
  std::string error_;
  std::string bytes_;
};

}  // namespace

absl::StatusOr<std::string> encodePng(std::span<const uint8_t> samples, uint32_t width_px,
                                      uint32_t height_px, uint32_t channels) {
  VIEWLOOM_CHECK(channels == 1 || channels == 3 || channels == 4);
  VIEWLOOM_CHECK(samples.size() == size_t{width_px} * height_px * channels);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width_px;
  image.height = height_px;
  image.format = channels == 1 ? PNG_FORMAT_GRAY : channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  image.flags = PNG_IMAGE_FLAG_FAST;  // a third of the time for a few percent of size
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, samples.data(), 0, nullptr) == 0) {
    return absl::InternalError(std::string("PNG: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

absl::StatusOr<std::string> encodePng16(std::span<const uint16_t> samples, uint32_t width_px,
                                        uint32_t height_px) {
  const size_t row_samples = size_t{3} * width_px;
  VIEWLOOM_CHECK(samples.size() == row_samples * height_px);
  std::vector<png_bytep> rows(height_px);
  for (size_t y = 0; y < rows.size(); ++y) {
    // libpng does not write to them.
    auto* const row = const_cast<uint16_t*>(samples.data() + y * row_samples);
    rows[y] = reinterpret_cast<png_bytep>(row);
  }
  PngWriter writer;
  if (!writer.write(rows.data(), width_px, height_px)) {
    return absl::InternalError("PNG: " + writer.error());
  }
  return writer.takeBytes();
}

}  // namespace viewloom::files
