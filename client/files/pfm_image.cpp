// SPDX-License-Identifier: Apache-2.0
#include "files/pfm_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/numbers.h"
#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/stored_samples.h"
#include "files/text_header.h"

namespace viewloom::files {
namespace {

struct PfmHeader {
  int64_t width_px = 0;
  int64_t height_px = 0;
  uint32_t channels = 0;
  bool is_big_endian = false;
  size_t end_bytes = 0;  // behind the scale
};

absl::StatusOr<PfmHeader> parseHeader(const std::string& name, std::span<const uint8_t> bytes) {
  TextHeader text(bytes);
  const std::string magic = text.takeWord();
  PfmHeader header;
  const bool has_sizes = absl::SimpleAtoi(text.takeWord(), &header.width_px) &&
                         absl::SimpleAtoi(text.takeWord(), &header.height_px);
  double scale = 0;
  if (!has_sizes || !absl::SimpleAtod(text.takeWord(), &scale) ||
      (magic != "PF" && magic != "Pf") || scale == 0 || !std::isfinite(scale)) {
    return refuseFile(name,
                      "has no PFM header; accepted is PF or Pf, width, height, scale: copy or "
                      "export it again");
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, header.height_px));
  header.channels = magic == "PF" ? 3 : 1;
  header.is_big_endian = scale > 0;
  header.end_bytes = text.offset();
  return header;
}

// One byte of white space ends the header, or CR LF: the file's length tells which.
absl::StatusOr<std::span<const uint8_t>> samplesOf(const std::string& name, const PfmHeader& header,
                                                   std::span<const uint8_t> bytes) {
  const size_t sample_bytes = size_t{4} * header.channels * static_cast<size_t>(header.width_px) *
                              static_cast<size_t>(header.height_px);
  const size_t left = bytes.size() - header.end_bytes;
  if (left < sample_bytes + 1) return refuseCutShort(name, "PFM");
  const auto between = bytes.subspan(header.end_bytes, left - sample_bytes);
  if (between.size() > 2 || !std::all_of(between.begin(), between.end(), isSpaceByte)) {
    return refuseDamaged(
        name, "PFM",
        strCat("has ", bytes.size(), " bytes; ", header.width_px, "x", header.height_px,
               " px need ", header.end_bytes + 1 + sample_bytes));
  }
  return bytes.last(sample_bytes);
}

}  // namespace

absl::StatusOr<Picture> decodePfm(const std::string& name, std::span<const uint8_t> bytes) {
  const absl::StatusOr<PfmHeader> header = parseHeader(name, bytes);
  if (!header.ok()) return header.status();
  const auto samples = samplesOf(name, *header, bytes);
  if (!samples.ok()) return samples.status();
  Picture picture{.width_px = static_cast<uint32_t>(header->width_px),
                  .height_px = static_cast<uint32_t>(header->height_px),
                  .channels = header->channels,
                  .bits = 32,
                  .coding = {},
                  .bytes = {}};
  picture.bytes.resize(samples->size());
  const SampleType type{NumberKind::kFloat, 4, header->is_big_endian};
  for (size_t i = 0; i < picture.bytes.size() / 4; ++i) {
    storeSample(&(*samples)[4 * i], type, picture, i);
  }
  flipRows(picture.bytes, picture.height_px);
  return picture;
}

absl::StatusOr<PlaneImage> readPfmColor(const std::filesystem::path& path) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  absl::StatusOr<Picture> picture = decodePfm(path.string(), *bytes);
  if (!picture.ok()) return picture.status();
  return colorPlane(*std::move(picture), v1::COLOR_TRANSFER_UNSPECIFIED);
}

absl::StatusOr<PlaneImage> readPfmDepth(const std::filesystem::path& path) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  const absl::StatusOr<Picture> picture = decodePfm(path.string(), *bytes);
  if (!picture.ok()) return picture.status();
  return depthPlane(path.string(), *picture, false);
}

}  // namespace viewloom::files
