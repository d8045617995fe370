// SPDX-License-Identifier: Apache-2.0
#include "encode/jpeg_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <new>

#include <jerror.h>

#include "base/check.h"
#include "encode/quilt_exif.h"

namespace viewloom {
namespace {

// Second bytes of JPEG markers (ITU-T T.81, table B.1).
constexpr uint8_t kSof0 = 0xC0;
constexpr uint8_t kRst0 = 0xD0;
constexpr uint8_t kRst7 = 0xD7;
constexpr uint32_t kRestartCount = kRst7 - kRst0 + 1;
constexpr uint8_t kEoi = 0xD9;
constexpr uint8_t kSos = 0xDA;
constexpr size_t kMarker_bytes = 2;

constexpr size_t kFirstStream_bytes = size_t{64} * 1024;

// Called by jpeg_write_* on an error. Every parameter was checked before, so an error is a want of
// memory, or our bug.
[[noreturn]] void failOnJpegError(j_common_ptr compressor) {
  if (compressor->err->msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
  compressor->err->output_message(compressor);
  failCheck(__FILE__, __LINE__, "libjpeg accepts the band");
}

bool isChannel(const BandPixels& pixels) {
  return pixels.plane != AtlasPlane::kColor;
}

void setColorSpace(jpeg_compress_struct& compressor, const BandPixels& pixels) {
  const bool is_rgba = pixels.form == ColorForm::kRgba;
  compressor.input_components = isChannel(pixels) ? 1 : is_rgba ? 4 : 3;
  compressor.in_color_space = isChannel(pixels) ? JCS_GRAYSCALE
                              : is_rgba         ? JCS_EXT_RGBX
                                                : JCS_YCbCr;
}

void setParameters(jpeg_compress_struct& compressor, const BandPixels& pixels,
                   const EncodingSpec& encoding) {
  compressor.image_width = pixels.width_px;
  compressor.image_height = pixels.row_count;
  setColorSpace(compressor, pixels);
  jpeg_set_defaults(&compressor);
  compressor.raw_data_in = pixels.form != ColorForm::kRgba;
  jpeg_set_quality(&compressor, static_cast<int>(encoding.jpeg_quality), TRUE);
  const int luma_sampling = !isChannel(pixels) && encoding.chroma == Chroma::k420 ? 2 : 1;
  compressor.comp_info[0].h_samp_factor = luma_sampling;
  compressor.comp_info[0].v_samp_factor = luma_sampling;
  compressor.restart_in_rows = 1;
  compressor.dct_method = JDCT_ISLOW;
}

// libjpeg reads through this pointer only; its type predates const.
JSAMPROW sampleRow(std::span<const uint8_t> samples, uint32_t row, size_t stride_bytes) {
  return const_cast<JSAMPROW>(samples.data()) + row * stride_bytes;
}

// Where a JPEG's header ends, and where in it the frame header holds the height.
struct JpegHeader {
  size_t size_bytes;
  size_t height_offset;
};

JpegHeader readHeader(const std::vector<uint8_t>& stream) {
  JpegHeader header{};
  for (size_t at = kMarker_bytes; header.size_bytes == 0;) {  // behind SOI: marker, length, ...
    VIEWLOOM_CHECK(at + 4 < stream.size());
    const uint8_t marker = stream[at + 1];
    const size_t segment_bytes = size_t{stream[at + 2]} << 8 | stream[at + 3];
    if (marker == kSof0) header.height_offset = at + 5;  // marker, length, precision
    at += kMarker_bytes + segment_bytes;
    if (marker == kSos) header.size_bytes = at;
  }
  return header;
}

// Numbers the restart markers between rows of MCUs that begin with this one of a band. Nothing else
// looks like such a marker: codes never have these second bytes.
void numberRestarts(std::span<uint8_t> rows, uint32_t first) {
  for (size_t at = 0; at + 1 < rows.size(); ++at) {
    if (rows[at] != 0xFF) continue;
    uint8_t& code = rows[at + 1];
    if (code < kRst0 || code > kRst7) continue;
    code = static_cast<uint8_t>(kRst0 + (code - kRst0 + first) % kRestartCount);
  }
}

}  // namespace

JpegEncoder::JpegEncoder(BytePool& pool) : pool_(pool), stream_(kFirstStream_bytes) {
  compressor_.err = jpeg_std_error(&errors_);
  errors_.error_exit = failOnJpegError;
  jpeg_create_compress(&compressor_);
  memory_ = std::make_unique<JpegMemory>(reinterpret_cast<j_common_ptr>(&compressor_));
  destination_.stream = &stream_;
  destination_.init_destination = [](j_compress_ptr compressor) {
    auto& to = *static_cast<Destination*>(compressor->dest);
    to.next_output_byte = to.stream->data();
    to.free_in_buffer = to.stream->size();
  };
  destination_.empty_output_buffer = [](j_compress_ptr compressor) -> boolean {
    growStream(*static_cast<Destination*>(compressor->dest));
    return TRUE;
  };
  destination_.term_destination = [](j_compress_ptr) {};
  compressor_.dest = &destination_;
}

JpegEncoder::~JpegEncoder() {
  jpeg_destroy_compress(&compressor_);
}

// libjpeg calls this when every byte is used, whatever free_in_buffer says.
void JpegEncoder::growStream(Destination& destination) {
  std::vector<uint8_t>& stream = *destination.stream;
  const size_t used_bytes = stream.size();
  stream.resize(2 * used_bytes);
  destination.next_output_byte = stream.data() + used_bytes;
  destination.free_in_buffer = stream.size() - used_bytes;
}

void JpegEncoder::writeRgba(const BandPixels& pixels) {
  while (compressor_.next_scanline < compressor_.image_height) {
    JSAMPROW row = sampleRow(pixels.bytes, compressor_.next_scanline, pixels.stride_bytes);
    jpeg_write_scanlines(&compressor_, &row, 1);
  }
}

void JpegEncoder::writeChannel(const BandPixels& pixels) {
  const auto channel = static_cast<size_t>(pixels.plane) - static_cast<size_t>(AtlasPlane::kRed);
  channel_row_.resize(pixels.width_px);
  while (compressor_.next_scanline < compressor_.image_height) {
    const uint8_t* const rgba =
        pixels.bytes.data() + compressor_.next_scanline * pixels.stride_bytes;
    for (size_t x = 0; x < channel_row_.size(); ++x) channel_row_[x] = rgba[4 * x + channel];
    JSAMPROW row = channel_row_.data();
    jpeg_write_scanlines(&compressor_, &row, 1);
  }
}

// An MCU row at a time, past libjpeg's conversion and downsampling. Below the last row that is
// there, it goes on.
void JpegEncoder::writePlanes(const BandPixels& pixels) {
  const uint32_t shared_px = pixels.form == ColorForm::kYcbcr420 ? 2 : 1;
  const uint32_t mcu_rows = DCTSIZE * shared_px;
  std::array<std::array<JSAMPROW, 2 * DCTSIZE>, 3> rows;
  std::array<JSAMPARRAY, 3> planes = {rows[0].data(), rows[1].data(), rows[2].data()};
  for (uint32_t first = 0; first < pixels.row_count; first += mcu_rows) {
    for (uint32_t i = 0; i < mcu_rows; ++i) {
      const uint32_t row = std::min(first + i, pixels.row_count - 1);
      rows[0][i] = sampleRow(pixels.bytes, row, pixels.stride_bytes);
    }
    for (uint32_t i = 0; i < DCTSIZE; ++i) {
      const uint32_t row = std::min(first / shared_px + i, (pixels.row_count - 1) / shared_px);
      rows[1][i] = sampleRow(pixels.cb, row, pixels.chroma_stride_bytes);
      rows[2][i] = sampleRow(pixels.cr, row, pixels.chroma_stride_bytes);
    }
    VIEWLOOM_CHECK(jpeg_write_raw_data(&compressor_, planes.data(), mcu_rows) == mcu_rows);
  }
}

size_t JpegEncoder::compress(const BandPixels& pixels, const EncodingSpec& encoding) {
  jpeg_abort_compress(&compressor_);  // memory may have run out in the middle of the last band
  setParameters(compressor_, pixels, encoding);
  jpeg_start_compress(&compressor_, TRUE);
  if (isChannel(pixels))
    writeChannel(pixels);
  else if (pixels.form == ColorForm::kRgba)
    writeRgba(pixels);
  else
    writePlanes(pixels);
  jpeg_finish_compress(&compressor_);
  return stream_.size() - destination_.free_in_buffer;
}

SharedBytes JpegEncoder::encode(const BandPixels& pixels, const EncodingSpec& encoding,
                                const AtlasLayout& layout) {
  const size_t stream_bytes = compress(pixels, encoding);
  const JpegHeader header = readHeader(stream_);
  const uint32_t image_height_px = layout.imageSize().height;
  const bool is_first = pixels.first_row == 0;
  const bool is_last = pixels.first_row + pixels.row_count == image_height_px;
  stream_[header.height_offset] = static_cast<uint8_t>(image_height_px >> 8);
  stream_[header.height_offset + 1] = static_cast<uint8_t>(image_height_px);
  const uint32_t mcu_rows = bandRowCount(encoding) / kRestartCount;
  const uint32_t first = pixels.first_row / mcu_rows % kRestartCount;
  const uint32_t last = first + (pixels.row_count - 1) / mcu_rows;
  const std::span<uint8_t> rows(stream_.data() + header.size_bytes, stream_.data() + stream_bytes);
  if (first > 0) numberRestarts(rows.first(rows.size() - kMarker_bytes), first);
  stream_[stream_bytes - 1] = is_last ? kEoi : static_cast<uint8_t>(kRst0 + last);

  const std::vector<uint8_t> exif = is_first ? quiltExif(layout) : std::vector<uint8_t>();
  const size_t begin = is_first ? kMarker_bytes : header.size_bytes;
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer bytes = pool_.take(std::bit_ceil(exif.size() + stream_bytes));
  if (is_first) bytes->assign(stream_.data(), stream_.data() + begin);
  bytes->insert(bytes->end(), exif.begin(), exif.end());
  bytes->insert(bytes->end(), stream_.data() + begin, stream_.data() + stream_bytes);
  return bytes;
}

}  // namespace viewloom
