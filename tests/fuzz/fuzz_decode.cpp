// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_decode.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "base/bounded_queue.h"
#include "base/check.h"
#include "decode/frame_decoder.h"
#include "decode/frame_intake.h"
#include "decode/jpeg_plane.h"
#include "decode/plane_decoder.h"
#include "decode/zstd_plane.h"
#include "frame/limits.h"

namespace viewloom {
namespace {

// Hands out the bytes of a script; zeros when it is at its end.
class Script {
 public:
  explicit Script(std::span<const uint8_t> bytes) : rest_(bytes) {}

  bool atEnd() const { return rest_.empty(); }

  uint32_t take(size_t count) {
    uint32_t value = 0;
    for (const uint8_t byte : takeBytes(count)) value = value << 8 | byte;
    return value;
  }

  std::span<const uint8_t> takeBytes(size_t count) {
    const std::span<const uint8_t> taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const uint8_t> rest_;
};

// Mostly what fits its place, sometimes anything.
PlaneFormat takePlane(Script& script, PlaneKind kind) {
  PlaneFormat plane;
  plane.kind = kind;
  plane.encoding = static_cast<PlaneEncoding>(script.take(1) % 7);
  plane.size_px = {script.take(1), script.take(1)};
  const uint32_t choice = script.take(1);
  plane.compression = choice & 1 ? PlaneCompression::kZstd : PlaneCompression::kNone;
  if (choice & 16) plane.compression = PlaneCompression::kPredictedZstd;
  if (choice & 2) plane.stride_bytes = script.take(2);
  if (choice & 4) plane.size_px.width = script.take(4);
  plane.depth.meaning = static_cast<DepthMeaning>(script.take(1) % 4);
  plane.depth.near_z_m = script.take(1);
  plane.depth.far_z_m = script.take(1);
  plane.wire_bytes = choice & 8 ? script.take(4) : uncompressedBytes(plane);
  return plane;
}

FrameFormat takeFormat(Script& script) {
  FrameFormat format;
  format.number = script.take(1);
  SourceFormat& source = format.sources.emplace_back();
  source.camera.intrinsics.focal_px.x = script.take(1);
  for (uint32_t layers = script.take(1) % 6; layers > 0; --layers) {
    LayerFormat& layer = source.layers.emplace_back();
    layer.depth_first = script.take(1) & 1;
    layer.color = takePlane(script, PlaneKind::kColor);
    layer.depth = takePlane(script, PlaneKind::kDepth);
  }
  return format;
}

std::string_view asText(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Chunks that follow on, but for a script that says otherwise.
bool collect(Script& script, const FrameFormat& format, FrameAssembly& assembly) {
  uint32_t plane = 0;
  for (const PlaneFormat* declared : wirePlanes(format)) {
    uint64_t offset = 0;
    while (offset < declared->wire_bytes && !script.atEnd()) {
      const uint32_t slip = script.take(1);
      const std::span<const uint8_t> data = script.takeBytes(slip);
      const bool astray = slip == 255;
      if (!assembly.addChunk(plane + astray, offset + (slip == 254), asText(data)).ok()) {
        return false;
      }
      offset += data.size();
    }
    ++plane;
  }
  return assembly.complete();
}

void checkPlanes(const Frame& frame) {
  const SourceFormat& source = frame.format.sources.at(0);
  for (size_t l = 0; l < source.layers.size(); ++l) {
    const LayerPlanes& planes = frame.sources.at(0).at(l);
    VIEWLOOM_CHECK(planes.color->size() == decodedBytes(source.layers[l].color));
    VIEWLOOM_CHECK(planes.depth->size() == decodedBytes(source.layers[l].depth));
  }
}

// The intake's threads, one frame at a time.
class IntakeUnderTest : public FrameSink {
 public:
  // The decoded frame; null when it is refused.
  FramePtr decode(CollectedFrame frame) {
    intake_.offer("s", std::move(frame), {}, [this](const FrameReport& report) {
      VIEWLOOM_CHECK(report.outcome == FrameOutcome::kRefused && !report.reason.empty());
      arrived_.push(nullptr);
    });
    return *arrived_.pop();
  }

  void offerFrame(const FrameOrigin&, FramePtr frame, ReportFrame) override {
    arrived_.push(std::move(frame));
  }
  void forgetStream(const std::string&) override {}

 private:
  SteadyClock clock_;
  BytePool pool_{8};
  BoundedQueue<FramePtr> arrived_{1};
  FrameIntake intake_{*this, clock_, pool_, {}};  // last: its threads use what is above
};

// Threads or none, a frame is the same.
void checkEqual(const Frame& a, const Frame& b) {
  for (size_t l = 0; l < a.format.sources.at(0).layers.size(); ++l) {
    VIEWLOOM_CHECK(*a.sources.at(0).at(l).color == *b.sources.at(0).at(l).color);
    VIEWLOOM_CHECK(*a.sources.at(0).at(l).depth == *b.sources.at(0).at(l).depth);
  }
}

}  // namespace

bool fuzzJpeg(std::span<const uint8_t> bytes) {
  static JpegDecoder decoder;
  Script script(bytes);
  const SizePx size_px{script.take(1), script.take(1)};
  std::vector<uint8_t> out;
  const bool decoded = decoder.decode(script.takeBytes(bytes.size()), size_px, out).ok();
  VIEWLOOM_CHECK(out.size() <= size_px.area() * 4);
  VIEWLOOM_CHECK(!decoded || out.size() == size_px.area() * 4);
  return decoded;
}

bool fuzzZstd(std::span<const uint8_t> bytes) {
  static ZstdInflater inflater;
  Script script(bytes);
  const uint64_t expected = script.take(2) + 1;
  const std::span<const uint8_t> wire = script.takeBytes(bytes.size());
  const absl::StatusOr<uint64_t> most = ZstdInflater::contentBytesUpTo(wire, expected);
  VIEWLOOM_CHECK(!most.ok() || *most <= expected);
  if (!ZstdInflater::contentBytes(wire, expected).ok()) return false;
  std::vector<uint8_t> out;
  const bool inflated = inflater.inflate(wire, expected, out).ok();
  VIEWLOOM_CHECK(out.size() <= expected);
  VIEWLOOM_CHECK(!inflated || out.size() == expected);
  return inflated;
}

bool fuzzPredicted(std::span<const uint8_t> bytes) {
  static BytePool pool(8);
  static PlaneDecoder decoder(pool);
  Script script(bytes);
  const PlaneFormat plane{.kind = PlaneKind::kDepth,
                          .encoding = PlaneEncoding::kDepthU16,
                          .size_px = {script.take(1) + 1, script.take(1) + 1},
                          .compression = PlaneCompression::kPredictedZstd};
  const std::span<const uint8_t> wire = script.takeBytes(bytes.size());
  const absl::StatusOr<SharedBytes> decoded =
      decoder.decode(plane, std::make_shared<const std::vector<uint8_t>>(wire.begin(), wire.end()));
  VIEWLOOM_CHECK(!decoded.ok() || (*decoded)->size() == decodedBytes(plane));
  return decoded.ok();
}

bool fuzzFrame(std::span<const uint8_t> bytes) {
  static BytePool pool(8);
  static FrameDecoder decoder(pool);
  static IntakeUnderTest intake;
  constexpr FrameLimits kLimits{.plane_side_px_max = 64, .frame_bytes_max = 1 << 16};
  Script script(bytes);
  const FrameFormat format = takeFormat(script);
  if (!validateFrame(format, kLimits).ok()) return false;
  FrameAssembly assembly(format, pool);
  if (!collect(script, format, assembly)) return false;
  const CollectedFrame collected = assembly.take();
  const absl::StatusOr<std::unique_ptr<Frame>> frame = decoder.decode(collected);
  const FramePtr by_threads = intake.decode(collected);
  VIEWLOOM_CHECK(frame.ok() == (by_threads != nullptr));
  if (!frame.ok()) return false;
  checkPlanes(**frame);
  checkEqual(**frame, *by_threads);
  return true;
}

}  // namespace viewloom
