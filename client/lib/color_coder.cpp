// SPDX-License-Identifier: Apache-2.0
#include "lib/color_coder.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/processor_count.h"
#include "lib/inverse_depth.h"
#include "lib/undefined_colors.h"
#include "video/openh264_encoder.h"
#include "video/still_pictures.h"

namespace viewloom {
namespace {

constexpr uint32_t kMacroblock_px = 16;
// Frames of several layers and sizes have few formats. A plane in several pictures has two.
constexpr size_t kEncodersMax = 8;
// Each thread codes a slice, which costs about 1 % of the bytes.
constexpr uint32_t kCoderThreadsMax = 4;
constexpr uint32_t kSliceRowsMin_px = 64;
// Longer sides exceed every level.
constexpr uint32_t kPictureSideMax_px = 8192;

SizePx planeSize(const v1::Plane& plane) {
  return {plane.size().width(), plane.size().height()};
}

size_t pixelBytes(const v1::Plane& plane) {
  return plane.encoding() == v1::PLANE_ENCODING_RGB8 ? 3 : 4;
}

size_t strideBytes(const v1::Plane& plane) {
  return plane.stride_bytes() > 0 ? plane.stride_bytes()
                                  : pixelBytes(plane) * size_t{plane.size().width()};
}

bool isPlain(const v1::Plane& plane) {
  return plane.compression() <= v1::PLANE_COMPRESSION_NONE;
}

// Whether video keeps what the plane says. Linear colour of 8 bits needs all of them in the dark.
bool canCode(const v1::Plane& plane, const SharedBytes& bytes) {
  const SizePx size_px = planeSize(plane);
  const bool is_rgb = plane.encoding() == v1::PLANE_ENCODING_RGB8;
  const bool is_opaque =
      plane.encoding() == v1::PLANE_ENCODING_RGBA8 && plane.alpha() <= v1::ALPHA_MODE_OPAQUE;
  return plane.kind() == v1::PLANE_KIND_COLOR && (is_rgb || is_opaque) && isPlain(plane) &&
         plane.transfer() != v1::COLOR_TRANSFER_LINEAR &&
         std::min(size_px.width, size_px.height) >= kVideoSideMin_px &&
         size_px.width <= kPictureSideMax_px &&
         bytes->size() == strideBytes(plane) * size_px.height;
}

// Rows of each picture of a plane, but the last: as few pictures as a codec takes.
uint32_t pictureRows(SizePx whole_px) {
  const uint64_t level_rows = kVideoAreaMax_px / whole_px.width / kMacroblock_px * kMacroblock_px;
  const uint64_t rows_max = std::min<uint64_t>(level_rows, kPictureSideMax_px);
  const uint64_t count = (whole_px.height + rows_max - 1) / rows_max;
  const uint64_t rows = (whole_px.height + count - 1) / count;
  return uint32_t((rows + kMacroblock_px - 1) / kMacroblock_px * kMacroblock_px);
}

// Index of the plane of a kind; -1 = the layer has none.
int indexOf(const v1::Layer& layer, v1::PlaneKind kind) {
  for (int i = 0; i < layer.planes_size(); ++i) {
    if (layer.planes(i).kind() == kind) return i;
  }
  return -1;
}

// 1/Z of the pixels of a colour plane; empty = not known, or there is a surface everywhere.
std::vector<float> surfacesOf(const v1::Source& source, const v1::Plane& color,
                              const v1::Plane& depth, const SharedBytes& bytes) {
  if (planeSize(depth) != planeSize(color) || !isPlain(depth)) return {};
  const std::optional<Intrinsics> intrinsics = depthIntrinsics(source);
  if (!intrinsics) return {};
  std::optional<std::vector<float>> inv_z =
      inverseDepth(depth, *bytes, *intrinsics, source.cube_map());
  if (!inv_z || std::ranges::find(*inv_z, kNoInvZ) == inv_z->end()) return {};
  return *std::move(inv_z);
}

}  // namespace

// RGB to the samples of a video, by libjpeg-turbo: its colours are those of JPEG files.
struct ColorCoder::Converter {
  Converter() : handle(tjInitCompress()) { VIEWLOOM_CHECK(handle != nullptr); }
  ~Converter() { tjDestroy(handle); }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  // The result is valid until the next call. Odd sides grow by a copy of their last column or row.
  VideoPicture convert(const uint8_t* pixels, size_t stride_bytes, SizePx size_px, TJPF format) {
    const SizePx even_px = stillSize(size_px);
    const size_t luma_bytes = even_px.area();
    const size_t chroma_stride = even_px.width / 2;
    samples.resize(luma_bytes * 3 / 2);
    std::array<uint8_t*, 3> planes = {samples.data(), samples.data() + luma_bytes,
                                      samples.data() + luma_bytes + luma_bytes / 4};
    std::array<int, 3> strides = {int(even_px.width), int(chroma_stride), int(chroma_stride)};
    const int code = tjEncodeYUVPlanes(handle, pixels, int(size_px.width), int(stride_bytes),
                                       int(size_px.height), format, planes.data(), strides.data(),
                                       TJSAMP_420, 0);
    VIEWLOOM_CHECK(code == 0);
    return {.size_px = even_px,
            .y = planes[0],
            .cb = planes[1],
            .cr = planes[2],
            .y_stride_bytes = even_px.width,
            .chroma_stride_bytes = chroma_stride};
  }

  const tjhandle handle;
  std::vector<uint8_t> samples;
};

ColorCoder::ColorCoder(const ColorVideo& options)
    : options_(options),
      thread_count_(std::min(processorCount(), kCoderThreadsMax)),
      converter_(std::make_unique<Converter>()) {}

ColorCoder::~ColorCoder() = default;

void ColorCoder::code(WireFrame& frame) {
  std::span<SharedBytes> planes = frame.planes;
  for (v1::Source& source : *frame.header.mutable_sources()) {
    for (v1::Layer& layer : *source.mutable_layers()) {
      const auto plane_count = size_t(layer.planes_size());
      codeLayer(source, layer, planes.first(plane_count));
      planes = planes.subspan(plane_count);
    }
  }
}

void ColorCoder::codeLayer(const v1::Source& source, v1::Layer& layer,
                           std::span<SharedBytes> planes) {
  const int color = indexOf(layer, v1::PLANE_KIND_COLOR);
  const int depth = indexOf(layer, v1::PLANE_KIND_DEPTH);
  if (color < 0) return;
  v1::Plane& plane = *layer.mutable_planes(color);
  SharedBytes& bytes = planes[size_t(color)];
  if (!canCode(plane, bytes) || planeSize(plane).area() < options_.area_min_px) return;
  std::vector<float> inv_z;
  if (depth >= 0) inv_z = surfacesOf(source, plane, layer.planes(depth), planes[size_t(depth)]);
  std::vector<uint8_t> video;
  if (inv_z.empty()) {
    video = coded(plane, bytes->data(), strideBytes(plane));
  } else {
    const size_t row_bytes = pixelBytes(plane) * plane.size().width();
    filled_.resize(row_bytes * plane.size().height());
    for (size_t y = 0; y < plane.size().height(); ++y) {
      std::copy_n(bytes->data() + y * strideBytes(plane), row_bytes, &filled_[y * row_bytes]);
    }
    fillUndefinedColors(inv_z, planeSize(plane), pixelBytes(plane), filled_);
    video = coded(plane, filled_.data(), row_bytes);
  }
  if (video.empty() || video.size() >= bytes->size()) return;
  plane.set_encoding(v1::PLANE_ENCODING_H264);
  plane.clear_stride_bytes();
  plane.set_bytes_count(video.size());
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(video));
}

// Empty if the encoder fails.
std::vector<uint8_t> ColorCoder::coded(const v1::Plane& plane, const uint8_t* pixels,
                                       size_t stride_bytes) {
  const SizePx size_px = planeSize(plane);
  const TJPF format = plane.encoding() == v1::PLANE_ENCODING_RGB8 ? TJPF_RGB : TJPF_RGBX;
  const uint32_t rows = pictureRows(stillSize(size_px));
  std::vector<uint8_t> video, picture_bytes;
  for (uint32_t row = 0; row < size_px.height; row += rows) {
    const SizePx picture_px = {size_px.width, std::min(rows, size_px.height - row)};
    VideoEncoder* const encoder = encoderOf(stillSize(picture_px));
    if (encoder == nullptr) return {};
    const VideoPicture picture =
        converter_->convert(pixels + row * stride_bytes, stride_bytes, picture_px, format);
    if (!encoder->encode(picture, Reference::kNone, picture_bytes).ok()) return {};
    video.insert(video.end(), picture_bytes.begin(), picture_bytes.end());
  }
  return video;
}

VideoEncoder* ColorCoder::encoderOf(SizePx size_px) {
  const uint32_t slice_count = std::max(size_px.height / kSliceRowsMin_px, 1U);
  const VideoFormat format = {
      .size_px = size_px, .qp = options_.qp, .thread_count = std::min(thread_count_, slice_count)};
  const auto found = std::ranges::find(encoders_, format, &VideoEncoder::format);
  if (found != encoders_.end()) return found->get();
  auto made = OpenH264Encoder::make(format);
  if (!made.ok()) return nullptr;
  if (encoders_.size() == kEncodersMax) encoders_.erase(encoders_.begin());
  encoders_.push_back(*std::move(made));
  return encoders_.back().get();
}

}  // namespace viewloom
