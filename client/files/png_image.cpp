// SPDX-License-Identifier: Apache-2.0
#include "files/png_image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/str_cat.h"
#include "files/exif.h"
#include "files/file_bytes.h"
#include "files/icc_profile.h"

namespace viewloom::files {
namespace {

constexpr char kCutShort[] = "cut short";

// One libpng reading. libpng reports errors by longjmp: each method that calls it sets its own
// landing place and keeps no object alive across it.
class PngReader {
 public:
  explicit PngReader(std::span<const uint8_t> bytes)
      : bytes_(bytes),
        rest_(bytes),
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
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_user_limits(png_, static_cast<png_uint_32>(kSideMax_px),
                        static_cast<png_uint_32>(kSideMax_px));
    png_set_read_fn(png_, this, &PngReader::onRead);
    png_read_info(png_, info_);
    return true;
  }

  // From here on samples are 8 or 16 bits (little endian), and colour is RGB or RGBA.
  bool expand(PictureUse use) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand(png_);
    if (use == PictureUse::kColor) png_set_gray_to_rgb(png_);
    png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool readRows(png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, info_);
    return true;
  }

  // Colour coding by the chunks before the samples. Chunks behind the samples count for nothing.
  ColorCoding coding() {
    png_charp name = nullptr;
    png_bytep profile = nullptr;
    png_uint_32 size = 0;
    int kind = 0;
    if (png_get_iCCP(png_, info_, &name, &kind, &profile, &size) != 0) {
      return codingOfIcc({profile, size});
    }
    ColorCoding coding;
    if (isSrgb()) return coding;
    double gamma = 0;
    if (png_get_gAMA(png_, info_, &gamma) != 0 && gamma > 0.01 && gamma < 100) {
      coding.gamma = gamma;
    }
    std::array<double, 8> xy{};  // white, red, green, blue
    if (png_get_cHRM(png_, info_, &xy[0], &xy[1], &xy[2], &xy[3], &xy[4], &xy[5], &xy[6], &xy[7]) !=
        0) {
      coding.has_chromaticities = true;
      for (size_t i = 0; i < 8; ++i) coding.xy[i] = static_cast<float>(xy[(i + 2) % 8]);
    }
    return coding;
  }

  // Also of a chunk behind the samples: ask when all is read.
  uint32_t orientation() {
    png_uint_32 size = 0;
    png_bytep exif = nullptr;
    if (png_get_eXIf_1(png_, info_, &size, &exif) == 0) return 1;
    return orientationOf(tiffOfExif({exif, size}));
  }

 private:
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    static_cast<PngReader*>(png_get_error_ptr(png))->error_ = message;
    png_longjmp(png, 1);
  }
  static void onRead(png_structp png, png_bytep out, png_size_t count) {
    std::span<const uint8_t>& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
    if (count > rest.size()) png_error(png, kCutShort);
    std::copy(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(count), out);
    rest = rest.subspan(count);
  }
  static void onWarning(png_structp, png_const_charp) {}  // odd ancillary chunks change no sample

  // Whether a chunk before the samples states sRGB. libpng forgets the chunk when gAMA or cHRM
  // contradicts it.
  bool isSrgb() const {
    constexpr size_t kSignatureBytes = 8, kFrameBytes = 12;  // of a chunk: length, name, CRC
    size_t at = kSignatureBytes;
    while (bytes_.size() >= kFrameBytes && at <= bytes_.size() - kFrameBytes) {
      const std::string_view name(reinterpret_cast<const char*>(&bytes_[at + 4]), 4);
      if (name == "sRGB") return true;
      if (name == "IDAT") return false;
      at += kFrameBytes + png_get_uint_32(&bytes_[at]);
    }
    return false;
  }

  std::span<const uint8_t> bytes_;
  std::span<const uint8_t> rest_;
  png_structp png_;
  png_infop info_;
  std::string error_;
};

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

absl::StatusOr<Picture> readPng(const std::filesystem::path& path, PictureUse use) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  return decodePng(path.string(), *bytes, use);
}

absl::StatusOr<Picture> decodePng(const std::string& name, std::span<const uint8_t> bytes,
                                  PictureUse use) {
  PngReader reader(bytes);
  const auto refusal = [&] {
    const bool is_short = reader.error() == kCutShort;
    return is_short ? refuseCutShort(name, "PNG") : refuseDamaged(name, "PNG", reader.error());
  };
  if (!reader.readHeader()) return refusal();
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, reader.width(), reader.height()));
  if (use == PictureUse::kDepth && reader.bitDepth() < 8) {
    return refuseFile(name, strCat("has samples of ", reader.bitDepth(),
                                   " bits; accepted as depth is grey of 8 or 16"));
  }
  const ColorCoding coding = use == PictureUse::kColor ? reader.coding() : ColorCoding();
  if (!reader.expand(use)) return refusal();
  Picture picture{.width_px = reader.width(),
                  .height_px = reader.height(),
                  .channels = reader.channels(),
                  .bits = reader.bitDepth(),
                  .coding = coding,
                  .bytes = std::vector<uint8_t>(reader.rowBytes() * reader.height())};
  std::vector<png_bytep> rows(picture.height_px);
  for (size_t y = 0; y < rows.size(); ++y) rows[y] = &picture.bytes[y * reader.rowBytes()];
  if (!reader.readRows(rows.data())) return refusal();
  return turned(std::move(picture), reader.orientation());
}

absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples) {
  absl::StatusOr<Picture> picture = readPng(path, PictureUse::kColor);
  if (!picture.ok()) return picture.status();
  return colorPlane(*std::move(picture),
                    linear_samples ? v1::COLOR_TRANSFER_LINEAR : v1::COLOR_TRANSFER_UNSPECIFIED);
}

absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread) {
  const absl::StatusOr<Picture> picture = readPng(path, PictureUse::kDepth);
  if (!picture.ok()) return picture.status();
  return depthPlane(path.string(), *picture, spread);
}

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
