// SPDX-License-Identifier: Apache-2.0
#include "files/pfm_image.h"

#include <Imath/half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// The text before the samples ends within this many bytes; longer ones are no PFM.
constexpr size_t kHeaderBytesMax = 256;

struct PfmHeader {
  int64_t width_px = 0;
  int64_t height_px = 0;
  uint32_t channels = 0;
  bool little_endian = false;
  size_t samples_offset_bytes = 0;
};

absl::StatusOr<PfmHeader> parseHeader(const std::string& file, const std::vector<uint8_t>& bytes) {
  std::istringstream text(std::string(
      bytes.begin(),
      bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), kHeaderBytesMax))));
  std::string magic;
  double scale = 0;
  PfmHeader header;
  text >> magic >> header.width_px >> header.height_px >> scale;
  if (!text || (magic != "PF" && magic != "Pf") || scale == 0 || !std::isfinite(scale)) {
    return refuseFile(file, "has no PFM header; accepted is PF or Pf, width, height, scale");
  }
  header.channels = magic == "PF" ? 3 : 1;
  header.little_endian = scale < 0;
  header.samples_offset_bytes = static_cast<size_t>(text.tellg()) + 1;  // one whitespace byte
  if (absl::Status size = checkPlaneSize(file, header.width_px, header.height_px); !size.ok()) {
    return size;
  }
  const size_t wanted = header.samples_offset_bytes + size_t{4} * header.channels *
                                                          static_cast<size_t>(header.width_px) *
                                                          static_cast<size_t>(header.height_px);
  if (bytes.size() != wanted) {
    return refuseFile(file, absl::StrCat("has ", bytes.size(), " bytes; ", header.width_px, "x",
                                         header.height_px, " px need ", wanted));
  }
  return header;
}

float sampleAt(const uint8_t* bytes, bool little_endian) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= uint32_t{bytes[i]} << (8 * (little_endian ? i : 3 - i));
  return std::bit_cast<float>(bits);
}

// Calls visit(index of the sample in top-down order, value) for every sample.
template <typename Visit>
void forEachSample(const PfmHeader& header, const std::vector<uint8_t>& bytes, const Visit& visit) {
  const auto row_samples = static_cast<size_t>(header.width_px) * header.channels;
  const auto height = static_cast<size_t>(header.height_px);
  for (size_t row = 0; row < height; ++row) {
    const size_t stored_row = height - 1 - row;
    const uint8_t* in = &bytes[header.samples_offset_bytes + 4 * stored_row * row_samples];
    for (size_t i = 0; i < row_samples; ++i) {
      visit(row * row_samples + i, sampleAt(in + 4 * i, header.little_endian));
    }
  }
}

struct PfmFile {
  PfmHeader header;
  std::vector<uint8_t> bytes;
};

absl::StatusOr<PfmFile> readPfm(const std::filesystem::path& path, uint32_t channels,
                                const char* accepted) {
  absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  const absl::StatusOr<PfmHeader> header = parseHeader(path.string(), *bytes);
  if (!header.ok()) return header.status();
  if (header->channels != channels) {
    return refuseFile(path.string(),
                      absl::StrCat("has ", header->channels, " channels; accepted is ", accepted));
  }
  return PfmFile{*header, *std::move(bytes)};
}

}  // namespace

absl::StatusOr<PlaneImage> readPfmColor(const std::filesystem::path& path) {
  const absl::StatusOr<PfmFile> file = readPfm(path, 3, "PF, 3 channels, as colour");
  if (!file.ok()) return file.status();
  PlaneImage image{.width_px = static_cast<uint32_t>(file->header.width_px),
                   .height_px = static_cast<uint32_t>(file->header.height_px),
                   .encoding = v1::PLANE_ENCODING_RGBA16F,
                   .has_alpha = false,
                   .bytes = {}};
  std::vector<uint16_t> rgba(size_t{4} * image.width_px * image.height_px,
                             Imath::half(1.0F).bits());
  forEachSample(file->header, file->bytes, [&](size_t index, float value) {
    rgba[index / 3 * 4 + index % 3] = Imath::half(value).bits();
  });
  image.bytes.resize(2 * rgba.size());
  std::memcpy(image.bytes.data(), rgba.data(), image.bytes.size());
  return image;
}

absl::StatusOr<PlaneImage> readPfmDepth(const std::filesystem::path& path) {
  const absl::StatusOr<PfmFile> file = readPfm(path, 1, "Pf, 1 channel, as depth");
  if (!file.ok()) return file.status();
  PlaneImage image{.width_px = static_cast<uint32_t>(file->header.width_px),
                   .height_px = static_cast<uint32_t>(file->header.height_px),
                   .encoding = v1::PLANE_ENCODING_DEPTH_F32,
                   .has_alpha = false,
                   .bytes = {}};
  image.bytes.resize(size_t{4} * image.width_px * image.height_px);
  forEachSample(file->header, file->bytes, [&](size_t index, float value) {
    std::memcpy(&image.bytes[4 * index], &value, sizeof(value));
  });
  return image;
}

}  // namespace viewloom::files
