// SPDX-License-Identifier: Apache-2.0
// Six faces of a cube map: pinhole cameras 90 degrees wide in one place (proto Source.cube_map).
#pragma once

#include <array>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "frame/camera.h"

namespace viewloom {

// Directions of the faces: +x, -x, +y, -y, +z, -z.
inline constexpr uint32_t kCubeFaceCount = 6;
// Face in the direction of the source's camera.
inline constexpr uint32_t kCubeFrontFace = 5;

// Size of a face in a plane of six faces, one below the other.
inline SizePx cubeFaceSize(SizePx plane_px) {
  return {plane_px.width, plane_px.height / kCubeFaceCount};
}

// Intrinsics of a face without its apron.
inline Intrinsics cubeFaceIntrinsics(uint32_t side_px) {
  return {.focal_px = glm::dvec2(0.5 * side_px), .principal_px = glm::dvec2(0.5 * side_px)};
}

// Orientation from a face to the cube: the camera that looks along -z, turned to the axis of the
// face. Faces to the side are upright. Faces above and below are what the front one sees with
// its head raised or bowed.
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

// Camera of a face with `apron_px` more known pixels around it.
inline Camera cubeFaceCamera(const Pose& cube, uint32_t face, uint32_t side_px,
                             uint32_t apron_px = 0) {
  Camera camera{.pose = {cube.position_m, cube.orientation * cubeFaceOrientation(face)},
                .intrinsics = cubeFaceIntrinsics(side_px)};
  camera.intrinsics.principal_px += double(apron_px);
  return camera;
}

}  // namespace viewloom
