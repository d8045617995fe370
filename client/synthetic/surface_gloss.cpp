// SPDX-License-Identifier: Apache-2.0
#include "synthetic/surface_gloss.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace viewloom::synthetic {

Gloss glossOf(const Hit& hit) {
  switch (hit.kind) {
    case SurfaceKind::kGround:
      return {.light = {0.30F, 0.34F, 0.38F}, .roughness = 0, .own_share = 0.35F};
    case SurfaceKind::kPanel:
      return {.light = {0.85F, 0.87F, 0.90F}, .roughness = 0, .own_share = 0.08F};
    case SurfaceKind::kSphere:
      if (hit.index == 1 || hit.index == 5) {  // chrome
        return {.light = {0.80F, 0.80F, 0.82F}, .roughness = 0, .own_share = 0.12F};
      }
      if (hit.index == 0 || hit.index == 4) {  // brushed copper
        return {.light = {0.75F, 0.45F, 0.30F}, .roughness = 0.4F, .own_share = 0.3F};
      }
      return {};
    default:
      return {};
  }
}

uint32_t octahedron(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const glm::vec3 on = normal / (size.x + size.y + size.z);
  const auto folded = [](float value, float other) {
    return std::copysign(1.0F - std::abs(other), value);
  };
  const glm::vec2 uv =
      on.z >= 0 ? glm::vec2(on) : glm::vec2(folded(on.x, on.y), folded(on.y, on.x));
  const auto code = [](float value) {
    return static_cast<uint32_t>(std::lround((std::clamp(value, -1.0F, 1.0F) + 1.0F) * 32767.5F));
  };
  return code(uv.x) | code(uv.y) << 16;
}

}  // namespace viewloom::synthetic
