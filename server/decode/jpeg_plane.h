// SPDX-License-Identifier: Apache-2.0
// Colour planes in baseline JPEG. Through the libjpeg API, which tells progressive and arithmetic
// coding apart (libturbojpeg does not).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// Keeps its working memory from plane to plane. Thread-safety: none; one per thread.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  // `out` becomes uint8_t[h][w][4], alpha 255. Refused before `out` grows: another size than
  // size_px, progressive, arithmetic-coded, not 8 bits, neither grey nor YCbCr, more than one scan.
  // Data that libjpeg would only warn about (truncated, corrupt) is refused too.
  absl::Status decode(std::span<const uint8_t> wire, SizePx size_px, std::vector<uint8_t>& out);

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace viewloom
