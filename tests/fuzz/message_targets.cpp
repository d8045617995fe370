// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/check.h"
#include "display/atlas_layout.h"
#include "frame/depth.h"
#include "frame/limits.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "lib/atlas_assembler.h"
#include "messages/display_from_proto.h"
#include "messages/eye_poses_from_proto.h"
#include "messages/wire_message.h"
#include "rpc/frame_from_proto.h"
#include "rpc/layout_to_proto.h"
#include "rpc/read_chunk.h"
#include "viewloom/v1/display_service.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

constexpr FrameLimits kSmallFrames{.plane_side_px_max = 64, .frame_bytes_max = 1 << 16};
constexpr AtlasLimits kSmallAtlases{
    .side_px_max = 1024, .area_px_max = 1 << 20, .view_count_max = 256};

// A refusal says what is wrong.
bool isAccepted(const absl::Status& status) {
  VIEWLOOM_CHECK(status.ok() || !status.message().empty());
  return status.ok();
}

template <typename Message>
std::optional<Message> messageOf(FuzzBytes bytes) {
  Message message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  return message;
}

void checkDepth(const PlaneFormat& depth) {
  const DepthCoefficients coefficients = makeDepthCoefficients(depth.depth, depth.encoding);
  VIEWLOOM_CHECK(std::isfinite(coefficients.scale) && std::isfinite(coefficients.offset));
  surfaceStep(depth);
}

// 3x2 px of two planes, as a call has it when chunks come.
FrameFormat smallFormat() {
  FrameFormat format{.number = 1};
  LayerFormat& layer = format.sources.emplace_back().layers.emplace_back();
  layer.color = {.size_px = {3, 2}, .wire_bytes = 24};
  layer.depth = {.kind = PlaneKind::kDepth,
                 .encoding = PlaneEncoding::kDepthU16,
                 .size_px = {3, 2},
                 .wire_bytes = 12};
  return format;
}

// A message as the network cuts it.
grpc::ByteBuffer slicesOf(FuzzBytes bytes, size_t slice_bytes) {
  std::vector<grpc::Slice> slices;
  while (!bytes.empty()) {
    const size_t count = std::min(slice_bytes, bytes.size());
    slices.emplace_back(bytes.data(), count);
    bytes = bytes.subspan(count);
  }
  return {slices.data(), slices.size()};
}

}  // namespace

bool fuzzHeader(FuzzBytes bytes) {
  const auto proto = messageOf<v1::FrameHeader>(bytes);
  if (!proto) return false;
  const absl::StatusOr<FrameFormat> format = frameFormatFromProto(*proto, kSmallFrames);
  if (!isAccepted(format.status())) return false;
  VIEWLOOM_CHECK(validateFrame(*format, kSmallFrames).ok());
  for (const PlaneFormat* plane : wirePlanes(*format)) {
    VIEWLOOM_CHECK(decodedBytes(*plane) <= kSmallFrames.frame_bytes_max);
    if (plane->kind == PlaneKind::kDepth) checkDepth(*plane);
  }
  return true;
}

bool fuzzDisplay(FuzzBytes bytes) {
  const auto proto = messageOf<v1::OpenDisplay>(bytes);
  if (!proto) return false;
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(proto->display());
  if (!isAccepted(spec.status())) return false;
  if (!isAccepted(validateAtlasLimits(*spec, kSmallAtlases))) return false;
  // Viewers share the work of a display whose key is the same.
  const absl::StatusOr<DisplaySpec> again = completeDisplaySpec(*spec);
  VIEWLOOM_CHECK(again.ok() && displayKey(*again) == displayKey(*spec));
  const absl::StatusOr<EncodingSpec> encoding = encodingFromProto(proto->encoding(), *spec);
  if (isAccepted(encoding.status())) VIEWLOOM_CHECK(validateEncodingSpec(*encoding).ok());
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(
      *spec, {.source_intrinsics = {.focal_px = {300, 300}, .principal_px = {160, 120}},
              .source_size_px = {320, 240}});
  if (!isAccepted(layout.status())) return false;
  VIEWLOOM_CHECK(std::max(layout->size_px.width, layout->size_px.height) <=
                 kSmallAtlases.side_px_max);
  if (!encoding.ok()) return false;
  // Clients take it.
  v1::StreamAtlasesResponse response;
  *response.mutable_layout() = layoutToProto(*layout, *encoding);
  VIEWLOOM_CHECK(AtlasAssembler().add(std::move(response)).ok());
  return true;
}

bool fuzzEyePoses(FuzzBytes bytes) {
  const auto proto = messageOf<v1::EyePoses>(bytes);
  if (!proto) return false;
  const size_t eye_count = proto->eyes_size() == 1 ? 1 : 2;
  return isAccepted(eyePosesFromProto(*proto, eye_count).status());
}

bool fuzzChunk(FuzzBytes bytes) {
  static BytePool pool(8);
  Script script(bytes);
  const size_t slice_bytes = 1 + script.take();
  const FuzzBytes wire = script.takeRest();
  FrameAssembly direct(smallFormat(), pool);
  grpc::ByteBuffer buffer = slicesOf(wire, slice_bytes);
  const auto read = readChunk(buffer, direct);
  const auto parsed = messageOf<v1::PublishFramesRequest>(wire);
  // Bytes that are read without protobuf are a chunk to it, too, and the same one.
  if (!read) return false;
  VIEWLOOM_CHECK(parsed && parsed->has_chunk());
  FrameAssembly by_proto(smallFormat(), pool);
  const v1::FrameChunk& chunk = parsed->chunk();
  const absl::Status added =
      by_proto.addChunk(chunk.plane_index(), chunk.offset_bytes(), chunk.data());
  VIEWLOOM_CHECK(added == read->status());
  if (!isAccepted(added)) return false;
  VIEWLOOM_CHECK(**read == chunk.data().size() && direct.complete() == by_proto.complete());
  return true;
}

}  // namespace viewloom
