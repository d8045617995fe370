// SPDX-License-Identifier: Apache-2.0
#include "lens/beam.h"

#include <array>

#include <glm/common.hpp>

namespace viewloom {
namespace {

// Where a ray is. The eye: homogeneous px of the source, m; the direction: for a metre along the
// view's axis.
glm::vec2 placeAt(glm::vec3 eye, glm::vec3 direction, float inv_z) {
  return glm::vec2(direction) / direction.z * (1 - inv_z * eye.z) + inv_z * glm::vec2(eye);
}

glm::vec4 rimAt(const abi::ViewParams& view, glm::vec3 direction, float inv_z) {
  const glm::vec2 middle = placeAt(view.eye, direction, inv_z);
  const auto beside = [&](glm::vec3 moved) {
    return placeAt(view.eye + moved, direction - view.lens_inv_focus * moved, inv_z) - middle;
  };
  return {beside(view.lens_px_m.x * view.direction_dx),
          beside(view.lens_px_m.y * view.direction_dy)};
}

glm::vec3 directionOf(const abi::ViewParams& view, glm::vec2 px) {
  return view.direction + px.x * view.direction_dx + px.y * view.direction_dy;
}

RectPx around(const std::array<glm::vec2, 4>& places) {
  RectPx rect{places[0], places[0]};
  for (const glm::vec2 place : places) {
    rect = {glm::min(rect.low, place), glm::max(rect.high, place)};
  }
  return rect;
}

}  // namespace

Beam::Beam(const abi::ViewParams& view, glm::vec2 low_px, glm::vec2 high_px, float inv_z_near) {
  const std::array<glm::vec2, 4> corners = {
      {low_px, {high_px.x, low_px.y}, {low_px.x, high_px.y}, high_px}};
  std::array<glm::vec2, 4> far, near;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::vec3 direction = directionOf(view, corners[i]);
    far[i] = placeAt(view.eye, direction, 0);
    near[i] = placeAt(view.eye, direction, inv_z_near);
  }
  far_ = around(far);
  const RectPx at_near = around(near);
  pace_ = {(at_near.low - far_.low) / inv_z_near, (at_near.high - far_.high) / inv_z_near};
  const glm::vec3 middle = directionOf(view, 0.5F * (low_px + high_px));
  rim_far_ = rimAt(view, middle, 0);
  rim_pace_ = (rimAt(view, middle, inv_z_near) - rim_far_) / inv_z_near;
}

}  // namespace viewloom
