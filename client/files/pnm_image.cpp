// SPDX-License-Identifier: Apache-2.0
#include "files/pnm_image.h"

#include <cstring>

#include "files/file_bytes.h"
#include "files/stored_samples.h"
#include "files/text_header.h"

namespace viewloom::files {
namespace {

constexpr int64_t kCodeMax = 65535;

struct PnmHeader {
  int64_t width_px = 0;
  int64_t height_px = 0;
  int64_t code_max = 0;
  uint32_t channels = 1;
  bool is_text = false;
};

absl::StatusOr<PnmHeader> parseHeader(const std::string& name, TextHeader& text) {
  const std::string magic = text.takeWord();
  if (magic != "P2" && magic != "P3" && magic != "P5" && magic != "P6") {
    return refuseFile(name, "is no grey or colour PNM; accepted are P2, P3, P5 and P6 (PGM, PPM)");
  }
  PnmHeader header;
  header.width_px = text.takeNumber();
  header.height_px = text.takeNumber();
  header.code_max = text.takeNumber();
  header.channels = magic == "P3" || magic == "P6" ? 3 : 1;
  header.is_text = magic == "P2" || magic == "P3";
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, header.height_px));
  if (header.code_max >= 1 && header.code_max <= kCodeMax) return header;
  return refuseDamaged(name, "PNM", "its largest code is not within 1..65535");
}

absl::Status readText(const std::string& name, TextHeader& text, Picture& picture) {
  const size_t count = picture.pixelCount() * picture.channels;
  for (size_t i = 0; i < count; ++i) {
    const int64_t code = text.takeNumber();
    if (code < 0) return refuseCutShort(name, "PNM");
    if (code > picture.code_max) return refuseDamaged(name, "PNM", "a code is above the largest");
    const auto stored = static_cast<uint16_t>(code);
    std::memcpy(&picture.bytes[picture.bits / 8 * i], &stored, picture.bits / 8);
  }
  return absl::OkStatus();
}

absl::Status readBinary(const std::string& name, std::span<const uint8_t> samples,
                        Picture& picture) {
  if (samples.size() < picture.bytes.size()) return refuseCutShort(name, "PNM");
  const SampleType type{NumberKind::kUnsigned, picture.bits / 8, true};
  for (size_t i = 0; i < picture.bytes.size() / type.bytes; ++i) {
    storeSample(&samples[i * type.bytes], type, picture, i);
    if (picture.sampleAt(i) > static_cast<float>(picture.code_max)) {
      return refuseDamaged(name, "PNM", "a code is above the largest");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Picture> decodePnm(const std::string& name, std::span<const uint8_t> bytes) {
  TextHeader text(bytes);
  const absl::StatusOr<PnmHeader> header = parseHeader(name, text);
  if (!header.ok()) return header.status();
  Picture picture{.width_px = static_cast<uint32_t>(header->width_px),
                  .height_px = static_cast<uint32_t>(header->height_px),
                  .channels = header->channels,
                  .bits = header->code_max > 255 ? 16U : 8U,
                  .code_max = static_cast<uint32_t>(header->code_max),
                  .coding = {},
                  .bytes = {}};
  const size_t sample_count = picture.pixelCount() * picture.channels;
  // Each sample takes a byte at least: what is not there is not paid for.
  if (bytes.size() - text.offset() < sample_count) return refuseCutShort(name, "PNM");
  picture.bytes.resize(sample_count * (picture.bits / 8));
  const absl::Status read = header->is_text
                                ? readText(name, text, picture)
                                : readBinary(name, bytes.subspan(text.offset() + 1), picture);
  if (!read.ok()) return read;
  return picture;
}

}  // namespace viewloom::files
