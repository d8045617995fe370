// SPDX-License-Identifier: Apache-2.0
#include "files/png_image.h"

#include <Imath/half.h>
#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

enum class Want { kColor, kDepth };

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
  int channels() const { return png_get_channels(png_, info_); }
  int bitDepth() const { return png_get_bit_depth(png_, info_); }
  bool isPlainGrey() const {
    return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY && bitDepth() >= 8;
  }
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
  bool expand(Want want) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (want == Want::kColor) {
      png_set_expand(png_);
      png_set_gray_to_rgb(png_);
    }
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

struct Samples {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  int channels = 0;
  int bits = 0;
  std::vector<uint8_t> bytes;
};

absl::StatusOr<Samples> readSamples(const std::filesystem::path& path, Want want) {
  VIEWLOOM_RETURN_IF_ERROR(checkFile(path));
  PngReader reader(path);
  const auto refusal = [&] { return refuseFile(path.string(), "PNG: " + reader.error()); };
  if (!reader.readHeader()) return refusal();
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path.string(), reader.width(), reader.height()));
  if (want == Want::kDepth && !reader.isPlainGrey()) {
    return refuseFile(path.string(),
                      absl::StrCat("has ", reader.channels(), " channels of ", reader.bitDepth(),
                                   " bits; accepted as depth is grey of 8 or 16"));
  }
  if (!reader.expand(want)) return refusal();
  Samples samples{.width_px = reader.width(),
                  .height_px = reader.height(),
                  .channels = reader.channels(),
                  .bits = reader.bitDepth(),
                  .bytes = std::vector<uint8_t>(reader.rowBytes() * reader.height())};
  std::vector<png_bytep> rows(samples.height_px);
  for (size_t y = 0; y < rows.size(); ++y) rows[y] = &samples.bytes[y * reader.rowBytes()];
  if (!reader.readRows(rows.data())) return refusal();
  return samples;
}

uint16_t sample16(const Samples& samples, size_t index) {
  uint16_t value = 0;
  std::memcpy(&value, &samples.bytes[2 * index], sizeof(value));
  return value;
}

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

std::vector<uint8_t> halfRgba(const Samples& samples, bool linear_samples) {
  const size_t pixel_count = size_t{samples.width_px} * samples.height_px;
  const auto channels = static_cast<size_t>(samples.channels);
  std::vector<uint8_t> bytes(8 * pixel_count);
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    std::array<uint16_t, 4> rgba{0, 0, 0, Imath::half(1.0F).bits()};
    for (size_t channel = 0; channel < channels; ++channel) {
      const float stored =
          static_cast<float>(sample16(samples, pixel * channels + channel)) / 65535.0F;
      const bool as_is = linear_samples || channel == 3;
      rgba[channel] = Imath::half(as_is ? stored : linearFromSrgb(stored)).bits();
    }
    std::memcpy(&bytes[8 * pixel], rgba.data(), 8);
  }
  return bytes;
}

}  // namespace

absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples) {
  absl::StatusOr<Samples> samples = readSamples(path, Want::kColor);
  if (!samples.ok()) return samples.status();
  const bool has_alpha = samples->channels == 4;
  PlaneImage image{.width_px = samples->width_px,
                   .height_px = samples->height_px,
                   .encoding = has_alpha ? v1::PLANE_ENCODING_RGBA8 : v1::PLANE_ENCODING_RGB8,
                   .has_alpha = has_alpha,
                   .bytes = {}};
  if (samples->bits == 16) {
    image.encoding = v1::PLANE_ENCODING_RGBA16F;
    image.bytes = halfRgba(*samples, linear_samples);
  } else {
    image.bytes = std::move(samples->bytes);
  }
  return image;
}

absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread) {
  absl::StatusOr<Samples> samples = readSamples(path, Want::kDepth);
  if (!samples.ok()) return samples.status();
  PlaneImage image{.width_px = samples->width_px,
                   .height_px = samples->height_px,
                   .encoding = v1::PLANE_ENCODING_DEPTH_U16,
                   .has_alpha = false,
                   .bytes = {}};
  if (samples->bits == 16) {
    image.bytes = std::move(samples->bytes);
    return image;
  }
  image.bytes.reserve(2 * samples->bytes.size());
  for (const uint8_t sample : samples->bytes) {
    image.bytes.push_back(sample);
    image.bytes.push_back(spread ? sample : 0);  // 257 * sample, or sample itself
  }
  return image;
}

}  // namespace viewloom::files
