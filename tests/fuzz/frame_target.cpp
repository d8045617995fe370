// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bounded_queue.h"
#include "base/check.h"
#include "base/clock.h"
#include "decode/frame_decoder.h"
#include "decode/frame_intake.h"
#include "frame/cube_map.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"

namespace viewloom {
namespace {

// A script of zeros is one source of one layer, RGBA8 and DEPTH_F32, of 1x1 px.

constexpr uint32_t kSourceIsCube = 1;
constexpr uint32_t kSourceHasPose = 2;

constexpr uint32_t kLayerDepthFirst = 1;
constexpr uint32_t kLayerHasReflections = 2;
constexpr uint32_t kLayerFirstOther = 4;  // motion; the next bits are the other kinds

constexpr uint32_t kPlaneEncodings = 7;
constexpr uint32_t kPlaneZstd = 8;
constexpr uint32_t kPlanePredicted = 16;
constexpr uint32_t kPlaneStride = 32;
constexpr uint32_t kPlaneOwnSize = 64;
constexpr uint32_t kPlaneOddBytes = 128;

// How many bytes a chunk takes from the script, or:
constexpr uint32_t kFillPlane = 0;
constexpr uint32_t kWrongOffset = 254;
constexpr uint32_t kWrongPlane = 255;

constexpr std::array kOtherKinds = {PlaneKind::kMotion, PlaneKind::kNormal, PlaneKind::kRoughness,
                                    PlaneKind::kSpecular};

// The first is that of a script of zeros. Some do not fit their kind.
PlaneEncoding encodingOf(PlaneKind kind, uint32_t choice) {
  using enum PlaneEncoding;
  constexpr std::array kColors = {kRgba8, kRgb8, kRgba16f, kJpeg, kXyz8, kH264};
  constexpr std::array kDepths = {kDepthF32, kDepthF16, kDepthU16, kR8};
  constexpr std::array kVectors = {kXyz16f, kXyz8, kOct16, kDepthF16};
  constexpr std::array kAmounts = {kR8, kRgb8, kRgba8, kJpeg};
  switch (kind) {
    case PlaneKind::kColor:
      return kColors.at(choice % kColors.size());
    case PlaneKind::kDepth:
      return kDepths.at(choice % kDepths.size());
    case PlaneKind::kMotion:
    case PlaneKind::kNormal:
      return kVectors.at(choice % kVectors.size());
    default:
      return kAmounts.at(choice % kAmounts.size());
  }
}

PlaneFormat takePlane(Script& script, PlaneKind kind, SizePx size_px) {
  PlaneFormat plane{.kind = kind, .size_px = size_px};
  const uint32_t choice = script.take();
  plane.encoding = encodingOf(kind, choice & kPlaneEncodings);
  if (choice & kPlaneZstd) plane.compression = PlaneCompression::kZstd;
  if (choice & kPlanePredicted) plane.compression = PlaneCompression::kPredictedZstd;
  if (choice & kPlaneStride) plane.stride_bytes = script.take(2);
  if (choice & kPlaneOwnSize) plane.size_px = {script.take(2), script.take(2)};
  const bool is_packed =
      plane.compression != PlaneCompression::kNone || isCodedPicture(plane.encoding);
  plane.wire_bytes = is_packed ? script.take(2) : uncompressedBytes(plane);
  if (choice & kPlaneOddBytes) plane.wire_bytes = script.take(4);
  const uint32_t attributes = script.take();
  if (kind == PlaneKind::kColor) {
    plane.alpha = static_cast<AlphaMode>(attributes % 3);
    plane.transfer = static_cast<ColorTransfer>(attributes / 3 % 2);
  } else if (kind == PlaneKind::kNormal) {
    plane.normal_space = static_cast<NormalSpace>(attributes % 2);
  } else if (kind == PlaneKind::kDepth) {
    plane.depth.meaning = static_cast<DepthMeaning>(attributes % 4);
    if (plane.depth.meaning == DepthMeaning::kWindow) {
      plane.depth.near_z_m = script.take();
      plane.depth.far_z_m = script.take();
    }
  }
  return plane;
}

LayerFormat takeLayer(Script& script, SizePx size_px) {
  const uint32_t choice = script.take();
  LayerFormat layer;
  layer.depth_first = choice & kLayerDepthFirst;
  layer.color_has_reflections = choice & kLayerHasReflections;
  layer.color = takePlane(script, PlaneKind::kColor, size_px);
  layer.depth = takePlane(script, PlaneKind::kDepth, size_px);
  for (size_t i = 0; i < kOtherKinds.size(); ++i) {
    if (choice & kLayerFirstOther << i) {
      layer.others.push_back(takePlane(script, kOtherKinds.at(i), size_px));
    }
  }
  return layer;
}

SourceFormat takeSource(Script& script) {
  const uint32_t choice = script.take();
  SourceFormat source;
  source.is_cube_map = choice & kSourceIsCube;
  if (choice & kSourceHasPose) {
    source.camera.pose.position_m.x = script.take();
    source.camera.pose.orientation.w = script.take();
    source.camera.intrinsics.focal_px.x = script.take();
  }
  SizePx size_px{1 + script.take() % 16, 1 + script.take() % 16};
  if (source.is_cube_map) size_px.height = kCubeFaceCount * size_px.width;
  for (uint32_t layers = 1 + script.take() % 5; layers > 0; --layers) {
    source.layers.push_back(takeLayer(script, size_px));
  }
  return source;
}

FrameFormat takeFormat(Script& script) {
  FrameFormat format;
  format.number = 1 + script.take();
  for (uint32_t sources = 1 + script.take() % 9; sources > 0; --sources) {
    format.sources.push_back(takeSource(script));
  }
  return format;
}

// Adds the next chunk of a plane, and counts its bytes.
bool addChunk(Script& script, uint32_t plane, uint64_t plane_bytes, uint64_t& offset,
              FrameAssembly& assembly) {
  const uint32_t choice = script.take();
  const std::string zeros(choice == kFillPlane ? plane_bytes - offset : 0, '\0');
  const std::string_view data =
      choice == kFillPlane ? std::string_view(zeros) : asText(script.takeBytes(choice));
  if (!assembly.addChunk(plane + (choice == kWrongPlane), offset + (choice == kWrongOffset), data)
           .ok()) {
    return false;
  }
  offset += data.size();
  return true;
}

// Whether the whole frame came.
bool collect(Script& script, const FrameFormat& format, FrameAssembly& assembly) {
  uint32_t plane = 0;
  for (const PlaneFormat* declared : wirePlanes(format)) {
    uint64_t offset = 0;
    while (offset < declared->wire_bytes) {
      if (!addChunk(script, plane, declared->wire_bytes, offset, assembly)) return false;
    }
    ++plane;
  }
  return assembly.complete();
}

void checkPlanes(const LayerFormat& format, const LayerPlanes& planes) {
  const uint64_t area = format.depth.size_px.area();
  VIEWLOOM_CHECK(planes.color->size() == decodedBytes(format.color));
  VIEWLOOM_CHECK(planes.depth->size() == decodedBytes(format.depth));
  VIEWLOOM_CHECK((planes.surface != nullptr) == format.mirrors());
  VIEWLOOM_CHECK(!planes.surface || planes.surface->size() == area * kSurfaceTexelBytes);
  VIEWLOOM_CHECK(planes.bad_normals_count <= area && planes.bad_motions_count <= area);
  // No plane of motion is kept where nothing moves.
  VIEWLOOM_CHECK(!planes.motion || format.find(PlaneKind::kMotion) != nullptr);
}

bool isEqual(const SharedBytes& a, const SharedBytes& b) {
  return a == nullptr || b == nullptr ? a == b : *a == *b;
}

// Threads or none, a frame is the same.
void checkEqual(const LayerPlanes& a, const LayerPlanes& b) {
  VIEWLOOM_CHECK(isEqual(a.color, b.color) && isEqual(a.depth, b.depth));
  VIEWLOOM_CHECK(isEqual(a.surface, b.surface) && isEqual(a.motion, b.motion));
  VIEWLOOM_CHECK(a.bad_normals_count == b.bad_normals_count);
  VIEWLOOM_CHECK(a.bad_motions_count == b.bad_motions_count);
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

}  // namespace

bool fuzzFrame(FuzzBytes bytes) {
  static BytePool pool(8);
  static FrameDecoder decoder(pool);
  static IntakeUnderTest intake;
  constexpr FrameLimits kLimits{.plane_side_px_max = 64, .frame_bytes_max = 1 << 18};
  Script script(bytes);
  const FrameFormat format = takeFormat(script);
  if (!validateFrame(format, kLimits).ok()) return false;
  FrameAssembly assembly(format, pool);
  if (!collect(script, format, assembly)) return false;
  const CollectedFrame collected = assembly.take();
  const absl::StatusOr<std::unique_ptr<Frame>> frame =
      decoder.decode({.format = collected.format, .planes = collected.planes});
  const FramePtr by_threads =
      intake.decode({.format = collected.format, .planes = collected.planes});
  VIEWLOOM_CHECK(frame.ok() == (by_threads != nullptr));
  if (!frame.ok()) return false;
  for (size_t s = 0; s < format.sources.size(); ++s) {
    const std::vector<LayerFormat>& layers = format.sources[s].layers;
    for (size_t l = 0; l < layers.size(); ++l) {
      checkPlanes(layers[l], (*frame)->sources.at(s).at(l));
      checkEqual((*frame)->sources[s][l], by_threads->sources.at(s).at(l));
    }
  }
  return true;
}

}  // namespace viewloom
