// SPDX-License-Identifier: Apache-2.0
#include "web/painted_stream.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "base/check.h"
#include "encode/compact_depth.h"

namespace viewloom {
namespace {

constexpr SizePx kSourceSize{1280, 720};
constexpr uint32_t kBitCount = 8;
constexpr int64_t kMs = 1'000'000;
constexpr double kFocal_m = 2;
// The cone of a tracked display.
constexpr uint32_t kConeViewCount = 48;
constexpr double kCone_rad = 40 * 3.14159265358979 / 180;
// Bands of a real atlas are cut at restart markers; joined they are one JPEG wherever they are cut.
constexpr size_t kBandCount = 3;

using Rgb = std::array<uint8_t, 3>;

Rgb background(double x, double y, double view_share) {
  const auto channel = [&](double phase) {
    const double wave = 0.5 + 0.5 * std::cos(6.283 * (view_share + phase + 0.25 * x));
    return static_cast<uint8_t>(40 + 150 * wave * (0.4 + 0.6 * y));
  };
  return {channel(0.0), channel(0.33), channel(0.67)};
}

Rgb tilePixel(SizePx tile, uint32_t x_px, uint32_t y_px, uint32_t view, uint32_t view_count,
              uint64_t frame) {
  const double x = (x_px + 0.5) / tile.width;
  const double y = (y_px + 0.5) / tile.height;
  const bool in_code = y > 0.375 && y < 0.625 && x > 0.1 && x < 0.9;
  if (in_code) {
    const auto bit = kBitCount - 1 - static_cast<uint32_t>((x - 0.1) / 0.8 * kBitCount);
    const uint8_t level = (view >> bit) & 1 ? 255 : 0;
    return {level, level, level};
  }
  const double bar = static_cast<double>(frame % 50) / 50;
  if (y < 0.06 && std::abs(x - bar) < 0.05) return {255, 255, 255};
  return background(x, y, double(view) / view_count);
}

Rgb flatPixel(uint32_t view, uint32_t view_count) {
  const auto level = static_cast<uint8_t>(std::lround(255.0 * view / (view_count - 1)));
  return {level, level, level};
}

// Views of a cone, and which of them an atlas shows from which on.
struct PaintedViews {
  uint32_t count = 1;
  uint32_t first = 0;
};

// View count of the whole cone. Views of a part of it keep their numbers in the whole cone.
PaintedViews viewsOf(const AtlasLayout& layout) {
  const double part = layout.cone_end > layout.cone_begin ? layout.cone_end - layout.cone_begin : 1;
  const auto count =
      static_cast<uint32_t>(std::lround(static_cast<double>(layout.views.size()) / part));
  return {count, static_cast<uint32_t>(std::lround(layout.cone_begin * count))};
}

PaintedViews viewsAt(const TrackedEye& eye) {
  const double share = std::atan(eye.pose.position_m.x / kFocal_m) / kCone_rad + 0.5;
  const double number = std::clamp(share * kConeViewCount - 0.5, 0.0, kConeViewCount - 1.0);
  return {kConeViewCount, static_cast<uint32_t>(std::lround(number))};
}

std::vector<uint8_t> paintAtlas(const AtlasLayout& layout, const PaintedViews& views,
                                uint64_t frame, bool is_flat) {
  std::vector<uint8_t> pixels(layout.size_px.area() * 3, 0);
  const SizePx tile = layout.tile_size_px;
  for (uint32_t tile_view = 0; tile_view < layout.views.size(); ++tile_view) {
    const TileOrigin origin = layout.tileOrigin(tile_view);
    const uint32_t view = views.first + tile_view;
    for (uint32_t y = 0; y < tile.height; ++y) {
      size_t at = (size_t{origin.y_px + y} * layout.size_px.width + origin.x_px) * 3;
      for (uint32_t x = 0; x < tile.width; ++x) {
        const Rgb pixel = is_flat ? flatPixel(view, views.count)
                                  : tilePixel(tile, x, y, view, views.count, frame);
        for (const uint8_t channel : pixel) pixels[at++] = channel;
      }
    }
  }
  return pixels;
}

std::vector<uint8_t> encodeJpeg(const std::vector<uint8_t>& pixels, SizePx size_px,
                                const EncodingSpec& encoding) {
  const tjhandle compressor = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  const int subsampling = encoding.chroma == Chroma::k444 ? TJSAMP_444 : TJSAMP_420;
  VIEWLOOM_CHECK(tjCompress2(compressor, pixels.data(), static_cast<int>(size_px.width), 0,
                             static_cast<int>(size_px.height), TJPF_RGB, &bytes, &length,
                             subsampling, static_cast<int>(encoding.jpeg_quality), 0) == 0);
  std::vector<uint8_t> jpeg(bytes, bytes + length);
  tjFree(bytes);
  tjDestroy(compressor);
  return jpeg;
}

// 1/Z from 0.25 / m at a tile's left to 1 / m at its right; nothing in padding.
EncodedBand paintDepth(const AtlasLayout& layout, BandEncoding encoding) {
  std::vector<float> inv_z(layout.size_px.area(), 0);
  const SizePx tile = layout.tile_size_px;
  for (uint32_t view = 0; view < layout.views.size(); ++view) {
    const TileOrigin origin = layout.tileOrigin(view);
    for (uint32_t y = 0; y < tile.height; ++y) {
      float* row = &inv_z[size_t{origin.y_px + y} * layout.size_px.width + origin.x_px];
      for (uint32_t x = 0; x < tile.width; ++x) {
        row[x] = static_cast<float>(0.25 + 0.75 * (x + 0.5) / tile.width);
      }
    }
  }
  const auto* bytes = reinterpret_cast<const uint8_t*>(inv_z.data());
  EncodedBand band{.plane = AtlasPlane::kDepth, .encoding = encoding};
  band.row_count = layout.size_px.height;
  const std::span<const uint8_t> samples(bytes, inv_z.size() * sizeof(float));
  if (encoding == BandEncoding::kCompactDepth) {
    BytePool pool(1);
    BandPixels pixels;
    pixels.plane = AtlasPlane::kDepth;
    pixels.row_count = layout.size_px.height;
    pixels.width_px = layout.size_px.width;
    pixels.bytes = samples;
    pixels.stride_bytes = pixels.width_px * sizeof(float);
    band.bytes = CompactDepthEncoder(pool).encode(pixels);
    return band;
  }
  band.bytes = std::make_shared<std::vector<uint8_t>>(samples.begin(), samples.end());
  return band;
}

std::vector<EncodedBand> cutIntoBands(const std::vector<uint8_t>& jpeg, uint32_t height_px) {
  std::vector<EncodedBand> bands;
  for (size_t i = 0; i < kBandCount; ++i) {
    const auto begin = static_cast<ptrdiff_t>(jpeg.size() * i / kBandCount);
    const auto end = static_cast<ptrdiff_t>(jpeg.size() * (i + 1) / kBandCount);
    EncodedBand band;
    band.first_row = static_cast<uint32_t>(height_px * i / kBandCount);
    band.row_count = static_cast<uint32_t>(height_px * (i + 1) / kBandCount) - band.first_row;
    band.bytes = std::make_shared<std::vector<uint8_t>>(jpeg.begin() + begin, jpeg.begin() + end);
    bands.push_back(std::move(band));
  }
  return bands;
}

}  // namespace

PaintedStream::PaintedStream(std::string name, StreamDirectory& streams, Broadcaster& broadcaster,
                             std::chrono::milliseconds per_megapixel, bool is_flat)
    : name_(std::move(name)),
      streams_(streams),
      broadcaster_(broadcaster),
      per_megapixel_(per_megapixel),
      is_flat_(is_flat),
      claim_(*streams.claim(name_, "painter", [] {})),
      painter_([this](const std::stop_token& stop) { run(stop); }) {
  streams_.noteResident(name_, 1, kSourceSize, 2, SourceStats{});
}

PaintedStream::~PaintedStream() = default;

void PaintedStream::publishFrame() {
  std::lock_guard lock(mutex_);
  ++wanted_frame_;
  changed_.notify_all();
}

void PaintedStream::noteDemand() {
  std::lock_guard lock(mutex_);
  demand_ = true;
  changed_.notify_all();
}

void PaintedStream::serveEyes(uint64_t display_id) {
  std::lock_guard lock(mutex_);
  moved_.insert(display_id);
  changed_.notify_all();
}

void PaintedStream::run(const std::stop_token& stop) {
  for (;;) {
    bool joiners_only = false;
    std::set<uint64_t> moved;
    {
      std::unique_lock lock(mutex_);
      const auto has_work = [this] {
        return demand_ || !moved_.empty() || wanted_frame_ != painted_frame_;
      };
      if (!changed_.wait(lock, stop, has_work)) return;
      joiners_only = wanted_frame_ == painted_frame_;
      painted_frame_ = wanted_frame_;
      demand_ = false;
      moved.swap(moved_);
    }
    if (!joiners_only) {
      streams_.countReceived(name_);
      streams_.noteResident(name_, painted_frame_, kSourceSize, 2, SourceStats{});
    }
    for (const ActiveDisplayPtr& display : broadcaster_.displays(name_)) {
      const bool is_asked =
          broadcaster_.newest(display->id) == nullptr || moved.contains(display->id);
      if (!joiners_only || is_asked) paint(*display);
    }
  }
}

void PaintedStream::paint(const ActiveDisplay& display) {
  const Camera camera{.pose = {},
                      .intrinsics = {.focal_px = {1000, 1000}, .principal_px = {640, 360}}};
  const EyePosesPtr poses = display.eyes ? display.eyes->newest() : nullptr;
  auto layout = makeAtlasLayout(display.spec,
                                {.source_intrinsics = camera.intrinsics,
                                 .source_size_px = kSourceSize,
                                 .focal_distance_m = kFocal_m},
                                poses.get());
  if (!layout.ok()) {
    broadcaster_.refuse(display.id, layout.status());
    return;
  }
  EncodedAtlas atlas;
  atlas.display_id = display.id;
  atlas.sequence = ++sequences_[display.id];
  atlas.frame_number = painted_frame_;
  atlas.layout = std::make_shared<AtlasLayout>(*std::move(layout));
  broadcaster_.noteLayout(display.id, atlas.layout);
  atlas.encoding = display.encoding;
  if (poses) {
    atlas.eye_poses_time_ns = poses->time_ns;
    atlas.predicted_display_time_ns = poses->predicted_display_time_ns;
    atlas.eye_poses_latched_ns = poses->received_ns;
  }
  atlas.times = {.receive_ns = 2 * kMs,
                 .decode_ns = 3 * kMs,
                 .upload_ns = 4 * kMs,
                 .build_ns = 12 * kMs,
                 .wait_ns = 1 * kMs,
                 .trace_ns = 70 * kMs,
                 .encode_ns = 30 * kMs,
                 .total_ns = 122 * kMs};
  atlas.coverage = {.hit = 900, .hit_assumed = 40, .hidden = 30, .outside = 20, .empty = 10};
  const SizePx size_px = atlas.layout->size_px;
  std::this_thread::sleep_for(per_megapixel_ * (static_cast<double>(size_px.area()) / 1e6));
  PaintedViews views = viewsOf(*atlas.layout);
  if (display.eyes) views = viewsAt(poses ? poses->eyes[0] : TrackedEye{});
  const std::vector<uint8_t> pixels = paintAtlas(*atlas.layout, views, painted_frame_, is_flat_);
  atlas.bands = cutIntoBands(encodeJpeg(pixels, size_px, display.encoding), size_px.height);
  if (display.encoding.with_depth) {
    atlas.bands.push_back(paintDepth(*atlas.layout, display.encoding.planes));
  }
  broadcaster_.publish(std::make_shared<const EncodedAtlas>(std::move(atlas)));
}

}  // namespace viewloom
