// SPDX-License-Identifier: Apache-2.0
// Frame headers that are spoilt in one place, and what they are refused with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "e2e/refusal.h"
#include "e2e/test_publisher.h"

namespace viewloom {

inline constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
inline constexpr auto kTooMuch = grpc::StatusCode::RESOURCE_EXHAUSTED;
inline constexpr auto kLater = grpc::StatusCode::UNIMPLEMENTED;

struct BadHeader {
  const char* name;
  std::function<void(v1::FrameHeader&)> spoil;
  grpc::StatusCode code;
  std::string field;
};

inline const std::string kSourcePath = "header.sources[0].";
inline const std::string kColorPath = kSourcePath + "layers[0].planes[0].";
inline const std::string kDepthPath = kSourcePath + "layers[0].planes[1].";
inline const std::string kCameraPath = kSourcePath + "camera.";

// Parts of a header of one source and one layer, as smallHeader() makes it.
inline v1::Layer& layerOf(v1::FrameHeader& header) {
  return *header.mutable_sources(0)->mutable_layers(0);
}
inline v1::Plane& color(v1::FrameHeader& header) {
  return *layerOf(header).mutable_planes(0);
}
inline v1::Plane& depth(v1::FrameHeader& header) {
  return *layerOf(header).mutable_planes(1);
}
inline v1::Camera& camera(v1::FrameHeader& header) {
  return *header.mutable_sources(0)->mutable_camera();
}
inline void setSize(v1::Plane& plane, uint32_t width, uint32_t height) {
  plane.mutable_size()->set_width(width);
  plane.mutable_size()->set_height(height);
}

// Each is refused as it says, and nobody else on the server is disturbed.
void expectRefused(const std::vector<BadHeader>& cases);

}  // namespace viewloom
