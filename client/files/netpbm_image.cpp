// SPDX-License-Identifier: Apache-2.0
#include "files/netpbm_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/stored_samples.h"

namespace viewloom::files {
namespace {

bool isSpaceByte(uint8_t byte) {
  return absl::ascii_isspace(byte);
}

// Words of the text that the files begin with. They are separated by white space and by comments,
// which go from # to the end of the line.
class TextHeader {
 public:
  explicit TextHeader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  // Up to `length_max` characters; "" at the end of the file, or where a word is longer.
  std::string takeWord(size_t length_max = 32);
  // A whole number of up to nine digits; -1 where there is none.
  int64_t takeNumber();

  // Behind the last word.
  size_t offset() const { return offset_; }

 private:
  void skipSpace();

  std::span<const uint8_t> bytes_;
  size_t offset_ = 0;
};

void TextHeader::skipSpace() {
  while (offset_ < bytes_.size()) {
    if (bytes_[offset_] == '#') {
      while (offset_ < bytes_.size() && bytes_[offset_] != '\n' && bytes_[offset_] != '\r') {
        ++offset_;
      }
    } else if (isSpaceByte(bytes_[offset_])) {
      ++offset_;
    } else {
      return;
    }
  }
}

std::string TextHeader::takeWord(size_t length_max) {
  skipSpace();
  const auto rest = bytes_.subspan(offset_);
  const auto end = std::find_if(rest.begin(), rest.end(),
                                [](uint8_t byte) { return isSpaceByte(byte) || byte == '#'; });
  const auto length = static_cast<size_t>(end - rest.begin());
  if (length > length_max) return "";
  offset_ += length;
  return {rest.begin(), end};
}

int64_t TextHeader::takeNumber() {
  const std::string word = takeWord();
  const bool has_digits_alone =
      !word.empty() && word.size() <= 9 &&
      std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  int64_t number = -1;
  return has_digits_alone && absl::SimpleAtoi(word, &number) ? number : -1;
}

constexpr int64_t kCodeMax = 65535;

struct PnmHeader {
  int64_t width_px = 0;
  int64_t height_px = 0;
  int64_t code_max = 0;
  uint32_t channels = 1;
  bool is_text = false;
};

absl::StatusOr<PnmHeader> parsePnmHeader(const std::string& name, TextHeader& text) {
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
  const absl::StatusOr<PnmHeader> header = parsePnmHeader(name, text);
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

namespace {

struct PfmHeader {
  int64_t width_px = 0;
  int64_t height_px = 0;
  uint32_t channels = 0;
  bool is_big_endian = false;
  size_t end_bytes = 0;  // behind the scale
};

absl::StatusOr<PfmHeader> parsePfmHeader(const std::string& name, std::span<const uint8_t> bytes) {
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
  const absl::StatusOr<PfmHeader> header = parsePfmHeader(name, bytes);
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
