// SPDX-License-Identifier: Apache-2.0
#include "admission/display_price.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/kind.h"
#include "display/video_stack.h"
#include "shared/trace_abi.h"

namespace viewloom {
namespace {

// Pictures of a display that are on their way at a time, each with its rays.
constexpr uint64_t kRaysCopies = 4;
// From this quality on, JPEG takes about twice as many bytes.
constexpr uint32_t kFineQuality = 91;
constexpr uint32_t kColorPixelBytes = 4;
constexpr uint32_t kDepthPixelBytes = 4;
constexpr uint32_t kCompactDepthPixelBytes = 1;  // at most half of that, and odd sides
constexpr uint32_t kCodePixelBytes = 2;

uint64_t encodedColorBytes(const EncodingSpec& encoding, uint64_t area_px) {
  switch (encoding.color) {
    case BandEncoding::kJpeg:
    case BandEncoding::kJpegPlanes:
      return encoding.jpeg_quality < kFineQuality ? area_px / 2 : area_px;
    case BandEncoding::kH264:
      return encoding.video_qp < matchedVideoQp(kFineQuality) ? area_px : area_px / 2;
    case BandEncoding::kZstd:
    case BandEncoding::kRaw:
    case BandEncoding::kCompactDepth:  // never of colour
      break;
  }
  return area_px * kColorPixelBytes;
}

uint32_t encodedDepthPixelBytes(const EncodingSpec& encoding) {
  if (!encoding.with_depth) return 0;
  return encoding.planes == BandEncoding::kCompactDepth ? kCompactDepthPixelBytes
                                                        : kDepthPixelBytes;
}

uint64_t encodedBytes(const EncodingSpec& encoding, uint64_t area_px) {
  return encodedColorBytes(encoding, area_px) +
         area_px * (encodedDepthPixelBytes(encoding) + (encoding.with_mask ? 1 : 0) +
                    (encoding.with_depth_codes ? kCodePixelBytes : 0));
}

// Stack of the views of a video; none for other encodings.
std::optional<VideoStack> stackOf(const TileGrid& grid, const EncodingSpec& encoding) {
  if (encoding.color != BandEncoding::kH264) return std::nullopt;
  const absl::StatusOr<VideoStack> stack = planVideoStack(grid.tile_size_px, grid.view_count);
  if (!stack.ok()) return std::nullopt;  // refused elsewhere
  return *stack;
}

uint64_t makingBytes(const EncodingSpec& encoding, uint64_t area_px) {
  const bool has_depth = encoding.with_depth || encoding.with_depth_codes;
  return area_px *
         (kColorPixelBytes + (has_depth ? kDepthPixelBytes : 0) + (encoding.with_mask ? 1 : 0));
}

uint64_t queuedBytes(uint64_t atlas_bytes) {
  return std::max(kQueuedAtlasesMin * atlas_bytes,
                  std::min(kQueuedAtlasesMax * atlas_bytes, kQueuedBytesMax));
}

// The largest atlas of the same shape that fits into what is left.
std::string fittingAtlas(const TileGrid& grid, uint64_t asked_bytes, uint64_t left_bytes) {
  constexpr double kRoundedDown = 0.98;
  const double scale = kRoundedDown * std::sqrt(double(left_bytes) / double(asked_bytes));
  const auto width_px = uint64_t(double(grid.width_px) * scale);
  const auto height_px = uint64_t(double(grid.height_px) * scale);
  constexpr uint64_t kSmallestWorthNaming_px = 16;
  if (std::min(width_px, height_px) < kSmallestWorthNaming_px) return "";
  return strCat("Such a display fits with an atlas of up to ", width_px, "x", height_px, " px");
}

}  // namespace

uint64_t DisplayPrice::viewerBytes() const {
  return kConnectionBytes + encoded_bytes + queue_bytes;
}

uint64_t atlasPixels(const DisplaySpec& spec) {
  const TileGrid grid = tileGridOf(spec);
  return grid.width_px * grid.height_px;
}

double pictureRate(const DisplaySpec& spec, double stream_rate_hz) {
  const double asked_hz = spec.temporal ? spec.temporal->output_rate_hz : 0;
  return asked_hz > 0 ? asked_hz : stream_rate_hz;
}

DisplayPrice displayPrice(const DisplaySpec& spec, const EncodingSpec& encoding) {
  const TileGrid grid = tileGridOf(spec);
  // Cells of a stack are larger than small views, and some may be empty.
  const std::optional<VideoStack> stack = stackOf(grid, encoding);
  const uint64_t area_px =
      stack ? stack->pictureSize().area() * stack->picture_count : grid.width_px * grid.height_px;
  const uint64_t samples =
      std::max(spec.filter.sample_count, spec.lens ? spec.lens->walked_count : 1U);
  const uint64_t pictures_bytes = stack ? videoPicturesBytes(*stack) : 0;
  const uint64_t encoder_bytes = stack ? videoEncoderBytes(stack->pictureSize()) : 0;
  const bool is_chained = stack && isChained(encoding);
  const uint64_t encoded_bytes = encodedBytes(encoding, area_px);
  return {.rays_bytes = kRaysCopies * samples * grid.view_count * sizeof(abi::ViewParams),
          .encoded_bytes = encoded_bytes,
          .making_bytes =
              makingBytes(encoding, area_px) + pictures_bytes + (is_chained ? 0 : encoder_bytes),
          .chain_bytes = is_chained ? encoder_bytes : 0,
          .queue_bytes = is_chained ? queuedBytes(encoded_bytes) : 0};
}

absl::StatusOr<Reservation> admitDisplay(MemoryBudget& budget, const DisplaySpec& spec,
                                         const EncodingSpec& encoding,
                                         const std::string& identity) {
  const DisplayPrice price = displayPrice(spec, encoding);
  const TileGrid grid = tileGridOf(spec);
  // A second rung is coded beside the first one, which may be at work or not.
  const uint64_t making_count = encoding.rung == VideoRung::kSecond ? 2 : 1;
  // Its first viewer comes right after it.
  const uint64_t asked_bytes =
      price.displayBytes() + making_count * price.making_bytes + price.viewerBytes();
  absl::StatusOr<Reservation> granted = budget.reserve(
      {.use = MemoryUse::kDisplays, .identity = identity, .bytes = asked_bytes},
      strCat("the display (", grid.view_count, grid.view_count == 1 ? " view, " : " views, ",
             grid.width_px, "x", grid.height_px, " px)"),
      [&](uint64_t left_bytes) { return fittingAtlas(grid, asked_bytes, left_bytes); });
  if (!granted.ok()) return withFieldPrefix(granted.status(), grid.size_field);
  granted->shrinkTo(price.displayBytes());
  return granted;
}

absl::StatusOr<Reservation> admitViewer(MemoryBudget& budget, const DisplaySpec& spec,
                                        const EncodingSpec& encoding, const std::string& identity) {
  const uint64_t asked_bytes = displayPrice(spec, encoding).viewerBytes();
  const TileGrid grid = tileGridOf(spec);
  return budget.reserve(
      {.use = MemoryUse::kViewers, .identity = identity, .bytes = asked_bytes},
      strCat("a viewer of this display (", grid.width_px, "x", grid.height_px, " px)"),
      [&](uint64_t left_bytes) { return fittingAtlas(grid, asked_bytes, left_bytes); });
}

}  // namespace viewloom
