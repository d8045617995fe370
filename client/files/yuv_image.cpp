// SPDX-License-Identifier: Apache-2.0
#include "files/yuv_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

struct FrameShape {
  uint32_t bits;
  size_t sample_bytes;
  size_t luma_count;    // samples
  size_t chroma_width;  // of each of two planes; 0 = none
  size_t chroma_height;

  size_t sampleCount() const { return luma_count + 2 * chroma_width * chroma_height; }
  uint64_t frameBytes() const { return uint64_t{sampleCount()} * sample_bytes; }
};

absl::StatusOr<FrameShape> shapeOf(const std::string& file, const v1::RawVideo& raw) {
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(file, raw.size().width(), raw.size().height()));
  const uint32_t bits = raw.sample_bits() == 0 ? 16 : raw.sample_bits();
  if (bits < 8 || bits > 16) {
    return invalidField("raw.sample_bits", strCat("is ", bits, "; accepted is 8..16"));
  }
  const size_t width = raw.size().width(), height = raw.size().height();
  return FrameShape{.bits = bits,
                    .sample_bytes = bits == 8 ? size_t{1} : 2,
                    .luma_count = width * height,
                    .chroma_width = raw.luma_alone() ? 0 : (width + 1) / 2,
                    .chroma_height = raw.luma_alone() ? 0 : (height + 1) / 2};
}

absl::StatusOr<uint32_t> frameCount(const std::filesystem::path& path, const v1::RawVideo& raw,
                                    const FrameShape& shape) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(path, error);
  if (error) return absl::NotFoundError(strCat(path.string(), ": ", error.message()));
  if (bytes == 0 || bytes % shape.frameBytes() != 0) {
    return refuseFile(
        path.string(),
        strCat("has ", bytes, " bytes; accepted are whole frames of ", shape.frameBytes(),
               ", which is ", raw.size().width(), "x", raw.size().height(), " px of ", shape.bits,
               " bits ", raw.luma_alone() ? "without chroma" : "in 4:2:0"));
  }
  return static_cast<uint32_t>(std::min<uint64_t>(bytes / shape.frameBytes(), UINT32_MAX));
}

// All samples of one frame, each in 16 bits.
absl::StatusOr<std::vector<uint16_t>> readSamples(const std::filesystem::path& path,
                                                  const v1::RawVideo& raw,
                                                  const FrameShape& shape) {
  const absl::StatusOr<uint32_t> count = frameCount(path, raw, shape);
  if (!count.ok()) return count.status();
  if (raw.frame_index() >= *count) {
    return refuseFile(path.string(), strCat("has ", *count, " frames; there is none of index ",
                                            raw.frame_index()));
  }
  std::vector<uint8_t> bytes(shape.frameBytes());
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(shape.frameBytes() * raw.frame_index()));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) return absl::DataLossError(strCat(path.string(), ": cannot be read"));
  std::vector<uint16_t> samples(shape.sampleCount());
  if (shape.sample_bytes == 2) {
    std::memcpy(samples.data(), bytes.data(), bytes.size());
  } else {
    std::copy(bytes.begin(), bytes.end(), samples.begin());
  }
  return samples;
}

PlaneImage emptyImage(const v1::RawVideo& raw, v1::PlaneEncoding encoding, size_t pixel_bytes) {
  PlaneImage image{.width_px = raw.size().width(),
                   .height_px = raw.size().height(),
                   .encoding = encoding,
                   .has_alpha = false,
                   .bytes = {}};
  image.bytes.resize(pixel_bytes * image.width_px * image.height_px);
  return image;
}

uint8_t code8(double value) {
  return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

}  // namespace

absl::StatusOr<uint32_t> yuvFrameCount(const std::filesystem::path& path, const v1::RawVideo& raw) {
  const absl::StatusOr<FrameShape> shape = shapeOf(path.string(), raw);
  if (!shape.ok()) return shape.status();
  return frameCount(path, raw, *shape);
}

absl::StatusOr<PlaneImage> readYuvColor(const std::filesystem::path& path,
                                        const v1::RawVideo& raw) {
  const absl::StatusOr<FrameShape> shape = shapeOf(path.string(), raw);
  if (!shape.ok()) return shape.status();
  const absl::StatusOr<std::vector<uint16_t>> samples = readSamples(path, raw, *shape);
  if (!samples.ok()) return samples.status();
  PlaneImage image = emptyImage(raw, v1::PLANE_ENCODING_RGB8, 3);
  // ITU-R BT.709: black at 16, white at 235, chroma 128 +- 112, in units of 2^(bits - 8).
  const double unit = std::exp2(shape->bits - 8.0);
  const size_t chroma_count = shape->chroma_width * shape->chroma_height;
  for (size_t y = 0; y < image.height_px; ++y) {
    for (size_t x = 0; x < image.width_px; ++x) {
      const double luma = ((*samples)[y * image.width_px + x] / unit - 16) / 219;
      double cb = 0, cr = 0;
      if (chroma_count > 0) {
        const size_t at = shape->luma_count + y / 2 * shape->chroma_width + x / 2;
        cb = ((*samples)[at] / unit - 128) / 224;
        cr = ((*samples)[at + chroma_count] / unit - 128) / 224;
      }
      uint8_t* const rgb = &image.bytes[3 * (y * image.width_px + x)];
      rgb[0] = code8(luma + 1.5748 * cr);
      rgb[1] = code8(luma - 0.187324 * cb - 0.468124 * cr);
      rgb[2] = code8(luma + 1.8556 * cb);
    }
  }
  return image;
}

absl::StatusOr<PlaneImage> readYuvDepth(const std::filesystem::path& path,
                                        const v1::RawVideo& raw) {
  const absl::StatusOr<FrameShape> shape = shapeOf(path.string(), raw);
  if (!shape.ok()) return shape.status();
  const absl::StatusOr<std::vector<uint16_t>> samples = readSamples(path, raw, *shape);
  if (!samples.ok()) return samples.status();
  PlaneImage image = emptyImage(raw, v1::PLANE_ENCODING_DEPTH_U16, 2);
  image.code_max = (1U << shape->bits) - 1;
  std::memcpy(image.bytes.data(), samples->data(), image.bytes.size());
  return image;
}

}  // namespace viewloom::files
