// SPDX-License-Identifier: Apache-2.0
#include "bench/video_coding.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "picture/atlas_strips.h"
#include "rpc/layout_to_proto.h"
#include "shared/ycbcr.h"
#include "support/ycbcr_planes.h"

namespace viewloom::bench {
namespace {

double usedMs() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return double(used.tv_sec) * 1e3 + double(used.tv_nsec) * 1e-6;
}

// Rows that worker threads hand on at a time.
constexpr uint32_t kStripRows = 128;

AtlasLayout stackedOf(AtlasLayout layout) {
  const absl::Status status = stackViews(layout);
  if (!status.ok()) throw std::runtime_error(std::string(status.message()));
  return layout;
}

// Copies the views into their cells. Cells that are larger repeat the last column and row.
std::vector<uint32_t> stack(const AtlasLayout& quilt, const AtlasLayout& stacked,
                            const std::vector<uint32_t>& rgba) {
  constexpr uint32_t kBlack = 0xff000000;
  std::vector<uint32_t> pixels(stacked.size_px.area(), kBlack);
  for (uint32_t view = 0; view < quilt.views.size(); ++view) {
    const TileOrigin from = quilt.tileOrigin(view);
    const TileOrigin to = stacked.tileOrigin(view);
    for (uint32_t y = 0; y < stacked.tile_size_px.height; ++y) {
      const size_t from_row = from.y_px + std::min(y, quilt.tile_size_px.height - 1);
      for (uint32_t x = 0; x < stacked.tile_size_px.width; ++x) {
        const size_t column = from.x_px + std::min(x, quilt.tile_size_px.width - 1);
        pixels[size_t{to.y_px + y} * stacked.size_px.width + to.x_px + x] =
            rgba[from_row * quilt.size_px.width + column];
      }
    }
  }
  return pixels;
}

std::vector<uint8_t> planesOf(const std::vector<uint32_t>& rgba, SizePx size_px) {
  return test::ycbcrPlanesOf(std::span<const uint32_t>(rgba), size_px, ColorForm::kYcbcr420);
}

double lumaOfPixel(uint32_t rgba) {
  return abi::lumaOf(float(rgba & 0xff), float(rgba >> 8 & 0xff), float(rgba >> 16 & 0xff));
}

AtlasBand bandOf(const EncodedBand& band, v1::BandEncoding encoding) {
  return {.image_index = band.image_index,
          .plane = v1::ATLAS_PLANE_COLOR,
          .first_row = band.first_row,
          .row_count = band.row_count,
          .encoding = encoding,
          .bytes = std::string(band.bytes->begin(), band.bytes->end())};
}

}  // namespace

std::unique_ptr<OpenH264Decoder> bareDecoder() {
  absl::StatusOr<std::unique_ptr<OpenH264Decoder>> made = OpenH264Decoder::make();
  if (!made.ok()) throw std::runtime_error(std::string(made.status().message()));
  return *std::move(made);
}

VideoCoding::VideoCoding(const AtlasLayout& layout, std::vector<uint32_t> rgba)
    : quilt_(layout),
      rgba_(std::move(rgba)),
      quilt_planes_(planesOf(rgba_, quilt_.size_px)),
      stacked_(stackedViews()) {}

VideoCoding::Stacked VideoCoding::stackedViews() const {
  Stacked stacked{.layout = stackedOf(quilt_), .planes = {}};
  stacked.planes = planesOf(stack(quilt_, stacked.layout, rgba_), stacked.layout.size_px);
  return stacked;
}

Atlas VideoCoding::emptyAtlas(const AtlasLayout& layout, const EncodingSpec& encoding) const {
  return {.layout = std::make_shared<const v1::AtlasLayout>(layoutToProto(layout, encoding)),
          .header = {},
          .end = {},
          .bands = {}};
}

// The error counts the pixels of the atlas, padding included.
void VideoCoding::finish(const Atlas& atlas, ColorDecoder& decoder, Coded& coded) const {
  coded.bytes = atlas.byteCount();
  const double begun_ms = usedMs();
  const absl::StatusOr<AtlasPicture> picture = decoder.decode(atlas);
  coded.decode_ms = usedMs() - begun_ms;
  if (!picture.ok()) throw std::runtime_error(std::string(picture.status().message()));
  double sum = 0;
  for (size_t i = 0; i < rgba_.size(); ++i) {
    const uint8_t* const rgb = &picture->samples[3 * i];
    const double error = lumaOfPixel(rgb[0] | uint32_t{rgb[1]} << 8 | uint32_t{rgb[2]} << 16) -
                         lumaOfPixel(rgba_[i]);
    sum += error * error;
  }
  coded.psnr_db = 10 * std::log10(255.0 * 255.0 * double(rgba_.size()) / sum);
}

void VideoCoding::measureLibrary(const Atlas& atlas, OpenH264Decoder& library, Coded& coded) const {
  const SizePx size_px = stacked_.layout.imageSize();
  const double begun_ms = usedMs();
  for (const AtlasBand& band : atlas.bands) {
    const std::vector<uint8_t> unit(band.bytes.begin(), band.bytes.end());
    const auto picture = library.decode(unit, size_px);
    if (!picture.ok()) throw std::runtime_error(std::string(picture.status().message()));
  }
  coded.library_ms = usedMs() - begun_ms;
}

Coded VideoCoding::asJpeg(uint32_t quality) {
  const EncodingSpec encoding = {.jpeg_quality = quality};
  const BandPixels pixels = planarPixels(quilt_planes_, quilt_.size_px, ColorForm::kYcbcr420);
  const uint32_t band_rows = bandRowCount(encoding);
  std::vector<EncodedBand> bands;
  Coded coded;
  const double begun_ms = usedMs();
  for (uint32_t row = 0; row < pixels.row_count; row += band_rows) {
    bands.push_back(jpeg_.encode(rowsOf(pixels, row, band_rows), encoding, quilt_));
  }
  coded.encode_ms = usedMs() - begun_ms;
  Atlas atlas = emptyAtlas(quilt_, encoding);
  for (const EncodedBand& band : bands) {
    atlas.bands.push_back(bandOf(band, v1::BAND_ENCODING_JPEG));
  }
  ColorDecoder decoder;
  finish(atlas, decoder, coded);
  return coded;
}

Coded VideoCoding::asVideo(uint32_t qp) {
  const EncodingSpec encoding = {.color = BandEncoding::kH264, .video_qp = qp};
  Coded coded;
  const Atlas atlas = codePictures(encoding, {.qp = qp}, PictureOrder::kForward, coded);
  ColorDecoder decoder;
  finish(atlas, decoder, coded);
  measureLibrary(atlas, *bareDecoder(), coded);
  return coded;
}

Coded VideoCoding::asChained(uint32_t qp, ChainEnds& chain) {
  const EncodingSpec encoding = {
      .color = BandEncoding::kH264, .video_qp = qp, .prediction = Prediction::kAcrossAtlases};
  const uint64_t before = chain.sequence++;
  Coded coded;
  const auto order = before % 2 == 0 ? PictureOrder::kForward : PictureOrder::kBackward;
  Atlas atlas = codePictures(
      encoding, {.qp = qp, .chain = chain.coder, .is_self_contained = before == 0}, order, coded);
  atlas.header.set_sequence(chain.sequence);
  atlas.header.set_is_backward(order == PictureOrder::kBackward);
  atlas.header.set_reference_sequence(before);
  finish(atlas, chain.decoder, coded);
  measureLibrary(atlas, *chain.library, coded);
  return coded;
}

Atlas VideoCoding::codePictures(const EncodingSpec& encoding, VideoStart start, PictureOrder order,
                                Coded& coded) {
  const AtlasLayout& layout = stacked_.layout;
  const AtlasStrips strips(layout, kStripRows, order);
  const BandPixels pixels = planarPixels(stacked_.planes, layout.size_px, ColorForm::kYcbcr420);
  const uint32_t height_px = layout.imageSize().height;
  std::vector<EncodedBand> bands;
  const double begun_ms = usedMs();
  VideoAtlas video(*layout.stack, encoding.video_qp);
  video.begin(std::move(start));
  for (uint32_t strip = 0; strip < strips.count(); ++strip) {
    const BandRows place = strips.rowsOf(strip);
    BandPixels rows = rowsOf(pixels, place.first_row, place.row_count);
    rows.first_row = strips.rowInImage(strip);
    if (!video.put(strips.placeOf(strip), rows, planes_)) continue;
    absl::StatusOr<CodedPicture> made = video.codeNext(encoders_, bytes_);
    if (!made.ok()) throw std::runtime_error(std::string(made.status().message()));
    bands.push_back({.image_index = strips.imageAt(made->place),
                     .row_count = height_px,
                     .encoding = BandEncoding::kH264,
                     .bytes = std::move(made->bytes)});
  }
  coded.encode_ms = usedMs() - begun_ms;
  Atlas atlas = emptyAtlas(layout, encoding);
  for (const EncodedBand& band : bands) {
    atlas.bands.push_back(bandOf(band, v1::BAND_ENCODING_H264));
  }
  return atlas;
}

}  // namespace viewloom::bench
