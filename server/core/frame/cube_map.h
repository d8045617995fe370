// SPDX-License-Identifier: Apache-2.0
// The six faces of a cube map: pinholes 90 degrees wide at one place (proto Source.cube_map).
#pragma once

#include <array>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "frame/camera.h"

namespace viewloom {

// +x, -x, +y, -y, +z, -z: the directions in which they look.
inline constexpr uint32_t kCubeFaceCount = 6;
// In the place of the source's camera, and as that is turned.
inline constexpr uint32_t kCubeFrontFace = 5;

// Of a plane that holds six faces, one below the other.
inline SizePx cubeFaceSize(SizePx plane_px) {
  return {plane_px.width, plane_px.height / kCubeFaceCount};
}

// Of a face without its apron.
inline Intrinsics cubeFaceIntrinsics(uint32_t side_px) {
  return {.focal_px = glm::dvec2(0.5 * side_px), .principal_px = glm::dvec2(0.5 * side_px)};
}

// Face to cube: the camera that looks along -z, turned until it looks along the face's axis. Faces
// to the side are upright; those above and below are what the front one sees with its head raised
// or bowed.
inline glm::dquat cubeFaceOrientation(uint32_t face) {
  struct Directions {
    glm::dvec3 forward;
    glm::dvec3 up;
  };
  constexpr std::array<Directions, kCubeFaceCount> kFaces = {{{{1, 0, 0}, {0, 1, 0}},
                                                              {{-1, 0, 0}, {0, 1, 0}},
                                                              {{0, 1, 0}, {0, 0, 1}},
                                                              {{0, -1, 0}, {0, 0, -1}},
                                                              {{0, 0, 1}, {0, 1, 0}},
                                                              {{0, 0, -1}, {0, 1, 0}}}};
  const auto& [forward, up] = kFaces.at(face);
  return glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(forward, up), up, -forward)));
}

// Of a face around which `apron_px` px more are known.
inline Camera cubeFaceCamera(const Pose& cube, uint32_t face, uint32_t side_px,
                             uint32_t apron_px = 0) {
  Camera camera{.pose = {cube.position_m, cube.orientation * cubeFaceOrientation(face)},
                .intrinsics = cubeFaceIntrinsics(side_px)};
  camera.intrinsics.principal_px += double(apron_px);
  return camera;
}

}  // namespace viewloom
