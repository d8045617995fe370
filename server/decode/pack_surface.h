// SPDX-License-Identifier: Apache-2.0
// How a layer mirrors: its planes of normals, roughness and specular colour as one of texels.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "base/byte_pool.h"
#include "frame/frame.h"

namespace viewloom {

// Decoded planes of a layer's `others`; null where there is none.
struct SurfacePlanes {
  SharedBytes normal;
  SharedBytes roughness;
  SharedBytes specular;

  SharedBytes& of(PlaneKind kind) {
    return kind == PlaneKind::kNormal      ? normal
           : kind == PlaneKind::kRoughness ? roughness
                                           : specular;
  }
};

// Fills in `surface` and `bad_normals_count` of a layer that mirrors. Normals are turned into the
// camera's space and made as long as 1; those that are not numbers, or have no length, count as
// bad: there, as without a plane of normals, the surface's own slope says where it faces. Without
// roughness all of it is a mirror.
void addSurface(const LayerFormat& layer, const SurfacePlanes& planes,
                const glm::dquat& world_from_camera, BytePool& pool, LayerPlanes& to);

}  // namespace viewloom
