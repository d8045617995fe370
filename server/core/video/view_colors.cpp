// SPDX-License-Identifier: Apache-2.0
#include "video/view_colors.h"

#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

#include "base/check.h"

namespace viewloom {
namespace {

// Rows of a view that are widened and converted at a time: their chroma stays in the cache, and the
// library is set up seldom. A Portrait quilt takes 19 ms as a whole, 17 by 8 rows, 14 by 16, 11.5
// by 64.
constexpr size_t kStripe_rows = 64;

// Chroma of a stripe of a view at the size of its luma. The nearer row and the nearer sample of a
// row count three times as much as the others (centres of 4:2:0 as in JPEG), as libjpeg
// interpolates it.
class WideChroma {
 public:
  explicit WideChroma(SizePx view_px)
      : count_((view_px.width + 1) / 2),
        row_count_((view_px.height + 1) / 2),
        columns_(count_ + 2),
        samples_(std::make_unique_for_overwrite<uint8_t[]>(2 * count_ * kStripe_rows)) {}

  size_t strideBytes() const { return 2 * count_; }
  const uint8_t* samples() const { return samples_.get(); }

  // plane: of the whole view. Rows are those of luma; kStripe_rows at most.
  void read(const uint8_t* plane, size_t stride_bytes, size_t first_row, size_t row_count) {
    for (size_t row = 0; row < row_count; ++row) {
      const size_t y = first_row + row;
      const size_t near = y / 2;
      const size_t far = y % 2 == 0 ? near - std::min<size_t>(near, 1)  //
                                    : std::min(near + 1, row_count_ - 1);
      mix(plane + near * stride_bytes, plane + far * stride_bytes);
      widen(samples_.get() + row * strideBytes());
    }
  }

 private:
  // Between two rows of samples, four times as large. The first and the last one are there twice.
  void mix(const uint8_t* near_row, const uint8_t* far_row) {
    uint16_t* const columns = columns_.data() + 1;
    for (size_t i = 0; i < count_; ++i) columns[i] = uint16_t(3 * near_row[i] + far_row[i]);
    columns_.front() = columns[0];
    columns_.back() = columns[count_ - 1];
  }
  void widen(uint8_t* row) const {
    const uint16_t* const columns = columns_.data();
    for (size_t i = 0; i < count_; ++i) {
      const auto near = uint16_t(3 * columns[i + 1] + 8);
      row[2 * i] = uint8_t(uint16_t(near + columns[i]) >> 4);
      row[2 * i + 1] = uint8_t(uint16_t(near + columns[i + 2]) >> 4);
    }
  }

  const size_t count_;  // of samples in a row
  const size_t row_count_;
  std::vector<uint16_t> columns_;
  const std::unique_ptr<uint8_t[]> samples_;
};

void writeColors(const VideoPicture& picture, const PictureCell& cell, TJPF format, uint8_t* pixels,
                 size_t stride_bytes) {
  const SizePx view_px = cell.view_px;
  VIEWLOOM_CHECK(cell.x_px % 2 == 0 && cell.y_px % 2 == 0 && view_px.area() > 0);
  VIEWLOOM_CHECK(cell.x_px + view_px.width <= picture.size_px.width);
  VIEWLOOM_CHECK(cell.y_px + view_px.height <= picture.size_px.height);
  const size_t chroma_origin = size_t{cell.y_px / 2} * picture.chroma_stride_bytes + cell.x_px / 2;
  WideChroma cb(view_px);
  WideChroma cr(view_px);
  const int strides[] = {int(picture.y_stride_bytes), int(cb.strideBytes()), int(cr.strideBytes())};
  const std::unique_ptr<void, int (*)(void*)> turbojpeg(tjInitDecompress(), tjDestroy);
  if (!turbojpeg) throw std::bad_alloc();
  for (size_t first = 0; first < view_px.height; first += kStripe_rows) {
    const size_t row_count = std::min(kStripe_rows, view_px.height - first);
    cb.read(picture.cb + chroma_origin, picture.chroma_stride_bytes, first, row_count);
    cr.read(picture.cr + chroma_origin, picture.chroma_stride_bytes, first, row_count);
    const unsigned char* planes[] = {
        picture.y + (cell.y_px + first) * picture.y_stride_bytes + cell.x_px, cb.samples(),
        cr.samples()};
    // Nothing but a lack of memory is left that could fail.
    if (tjDecodeYUVPlanes(turbojpeg.get(), planes, strides, TJSAMP_444,
                          pixels + first * stride_bytes, int(view_px.width), int(stride_bytes),
                          int(row_count), format, 0) != 0) {
      throw std::bad_alloc();
    }
  }
}

}  // namespace

void writeViewColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgb,
                     size_t stride_bytes) {
  writeColors(picture, cell, TJPF_RGB, rgb, stride_bytes);
}

void writeOpaqueColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgba,
                       size_t stride_bytes) {
  writeColors(picture, cell, TJPF_RGBA, rgba, stride_bytes);
}

}  // namespace viewloom
