// SPDX-License-Identifier: Apache-2.0
#include "decode/jpeg_plane.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE
#include <optional>
#include <stdexcept>
#include <string>

#include <jpeglib.h>

#include "base/str_cat.h"
#include "jpeg/jpeg_memory.h"

namespace viewloom {
namespace {

constexpr uint32_t kPixelBytes = 4;
// Rows asked for at once; libjpeg hands out one MCU row (at most 16 px) at a time.
constexpr JDIMENSION kRowsPerCall = 16;

// libjpeg reports through this: every error, and every warning that data is corrupt, jumps out.
struct Fault {
  jpeg_error_mgr manager;  // first: libjpeg's pointer to it is a pointer to the Fault
  jmp_buf escape;
  std::array<char, JMSG_LENGTH_MAX> message;
};

void jumpOut(j_common_ptr decoder) {
  auto* fault = reinterpret_cast<Fault*>(decoder->err);
  fault->manager.format_message(decoder, fault->message.data());
  longjmp(fault->escape, 1);
}

void jumpOutOnCorruption(j_common_ptr decoder, int level) {
  if (level < 0) jumpOut(decoder);
}

}  // namespace

// libjpeg leaves its calls by longjmp, over no object that has a destructor: each function here
// that sets a jump holds plain values alone.
struct JpegDecoder::Reader {
  jpeg_decompress_struct decoder{};
  Fault fault{};
  std::optional<JpegMemory> memory;

  bool create() {
    decoder.err = jpeg_std_error(&fault.manager);
    fault.manager.error_exit = jumpOut;
    fault.manager.emit_message = jumpOutOnCorruption;
    if (setjmp(fault.escape)) return false;
    jpeg_create_decompress(&decoder);
    return true;
  }

  bool readHeader(const uint8_t* bytes, size_t count) {
    if (setjmp(fault.escape)) return false;
    jpeg_abort_decompress(&decoder);  // memory may have run out in the middle of the last picture
    jpeg_mem_src(&decoder, bytes, count);
    jpeg_read_header(&decoder, TRUE);
    return true;
  }

  bool readPixels(uint8_t* rgba) {
    if (setjmp(fault.escape)) return false;
    decoder.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&decoder);
    const size_t row_bytes = size_t{decoder.output_width} * kPixelBytes;
    JSAMPROW rows[kRowsPerCall];
    while (decoder.output_scanline < decoder.output_height) {
      const JDIMENSION first = decoder.output_scanline;
      const JDIMENSION count = std::min(kRowsPerCall, decoder.output_height - first);
      for (JDIMENSION i = 0; i < count; ++i) rows[i] = rgba + (first + i) * row_bytes;
      jpeg_read_scanlines(&decoder, rows, count);
    }
    jpeg_finish_decompress(&decoder);
    return true;
  }

  absl::Status validateHeader(SizePx size_px) const;
};

absl::Status JpegDecoder::Reader::validateHeader(SizePx size_px) const {
  const auto refuse = [](std::string_view what) {
    return absl::InvalidArgumentError(
        strCat("the JPEG ", what,
               "; accepted is a baseline JPEG with 8 bits, grey or YCbCr, in one scan"));
  };
  if (decoder.progressive_mode) return refuse("is progressive");
  if (decoder.arith_code) return refuse("has arithmetic coding");
  if (decoder.data_precision != BITS_IN_JSAMPLE) {
    return refuse(strCat("has ", decoder.data_precision, " bits"));
  }
  if (decoder.jpeg_color_space == JCS_CMYK || decoder.jpeg_color_space == JCS_YCCK) {
    return refuse("is CMYK");
  }
  if (decoder.jpeg_color_space != JCS_GRAYSCALE && decoder.jpeg_color_space != JCS_YCbCr) {
    return refuse(strCat("has ", decoder.num_components, " channels in another colour space"));
  }
  if (decoder.comps_in_scan != decoder.num_components) return refuse("has several scans");
  if (decoder.image_width != size_px.width || decoder.image_height != size_px.height) {
    return absl::InvalidArgumentError(
        strCat("the JPEG has ", decoder.image_width, "x", decoder.image_height,
               " px; accepted is the declared size, ", size_px.width, "x", size_px.height));
  }
  return absl::OkStatus();
}

JpegDecoder::JpegDecoder() : reader_(std::make_unique<Reader>()) {
  if (!reader_->create()) throw std::runtime_error(reader_->fault.message.data());
  reader_->memory.emplace(reinterpret_cast<j_common_ptr>(&reader_->decoder));
}

JpegDecoder::~JpegDecoder() {
  jpeg_destroy_decompress(&reader_->decoder);
}

absl::Status JpegDecoder::decode(std::span<const uint8_t> wire, SizePx size_px,
                                 std::vector<uint8_t>& out) {
  const auto broken = [this] {
    jpeg_abort_decompress(&reader_->decoder);
    return absl::InvalidArgumentError(
        strCat("the bytes are not a whole baseline JPEG: ", reader_->fault.message.data()));
  };
  if (!reader_->readHeader(wire.data(), wire.size())) return broken();
  if (absl::Status status = reader_->validateHeader(size_px); !status.ok()) {
    jpeg_abort_decompress(&reader_->decoder);
    return status;
  }
  out.resize(size_px.area() * kPixelBytes);
  if (!reader_->readPixels(out.data())) return broken();
  return absl::OkStatus();
}

}  // namespace viewloom
