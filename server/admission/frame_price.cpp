// SPDX-License-Identifier: Apache-2.0
#include "admission/frame_price.h"

#include <algorithm>
#include <cmath>

#include "base/str_cat.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

uint64_t receivingBytes(const PlaneFormat& plane) {
  if (plane.compression == PlaneCompression::kNone && isHeldAsSent(plane)) return plane.wire_bytes;
  if (widensOnArrival(plane)) return decodedBytes(plane);
  const uint64_t unpacked_bytes = isHeldAsSent(plane) ? 0 : decodedBytes(plane);
  return plane.wire_bytes + inflatedBytesMax(plane) + unpacked_bytes + codecBytes(plane);
}

void add(const LayerFormat& layer, FramePrice& price) {
  price.receiving_bytes += receivingBytes(layer.color) + receivingBytes(layer.depth);
  price.decoded_bytes += decodedBytes(layer.color) + decodedBytes(layer.depth);
  for (const PlaneFormat& other : layer.others) {
    price.receiving_bytes += receivingBytes(other);
    if (other.kind != PlaneKind::kMotion) continue;
    price.decoded_bytes += decodedBytes(other);
    price.receiving_bytes += decodedBytes(other);  // the copy without bad vectors
  }
  const uint64_t surface_bytes =
      layer.mirrors() ? layer.depth.size_px.area() * kSurfaceTexelBytes : 0;
  price.receiving_bytes += surface_bytes;
  price.decoded_bytes += surface_bytes;
}

const SourceFormat& largestSource(const FrameFormat& format) {
  return *std::ranges::max_element(format.sources, {}, [](const SourceFormat& source) {
    return source.layers.front().depth.size_px.area();
  });
}

SizePx scaled(SizePx size_px, double scale) {
  const auto side = [scale](uint32_t side_px) {
    return std::max(1U, uint32_t(double(side_px) * scale));
  };
  return {side(size_px.width), side(size_px.height)};
}

std::string describe(const FrameFormat& format, SizePx size_px) {
  const SourceFormat& source = largestSource(format);
  const size_t source_count = format.sources.size();
  const size_t layer_count = source.layers.size();
  return strCat(source_count > 1 ? strCat(source_count, " sources, ") : "",
                layer_count > 1 ? strCat(layer_count, " layers, ") : "", size_px.width, "x",
                size_px.height, " px");
}

// Pixels decide the price, so that the sides go with its root.
std::string fittingFrame(const FrameFormat& format, uint64_t asked_bytes, uint64_t left_bytes) {
  constexpr double kRoundedDown = 0.98;
  const double scale = kRoundedDown * std::sqrt(double(left_bytes) / double(asked_bytes));
  const SizePx size_px = scaled(largestSource(format).layers.front().depth.size_px, scale);
  constexpr uint32_t kSmallestWorthNaming_px = 16;
  if (std::min(size_px.width, size_px.height) < kSmallestWorthNaming_px) return "";
  return strCat("Such a frame fits with up to ", size_px.width, "x", size_px.height, " px");
}

}  // namespace

FramePrice framePrice(const FrameFormat& format) {
  FramePrice price;
  for (const SourceFormat& source : format.sources) {
    for (const LayerFormat& layer : source.layers) add(layer, price);
  }
  price.receiving_bytes = std::max(price.receiving_bytes, price.decoded_bytes);
  return price;
}

absl::StatusOr<Reservation> admitFrame(MemoryBudget& budget, const FrameFormat& format,
                                       const PreparedBytes& prepared_bytes,
                                       const std::string& identity) {
  const FramePrice price = framePrice(format);
  const uint64_t asked_bytes = price.receiving_bytes + prepared_bytes(format);
  absl::StatusOr<Reservation> granted = budget.reserve(
      {.use = MemoryUse::kFrames, .identity = identity, .bytes = asked_bytes},
      strCat("the frame (", describe(format, largestSource(format).layers.front().depth.size_px),
             ")"),
      [&](uint64_t left_bytes) { return fittingFrame(format, asked_bytes, left_bytes); });
  if (!granted.ok()) return withFieldPrefix(granted.status(), "header");
  granted->shrinkTo(price.receiving_bytes);
  return granted;
}

}  // namespace viewloom
