// SPDX-License-Identifier: Apache-2.0
// True pictures of a scene whose surfaces mirror each other, and whether a source can know them.
#pragma once

#include <cstdint>
#include <vector>

#include "support/truth/known.h"
#include "support/truth/picture.h"

namespace viewloom::truth {

struct MirrorOptions {
  uint32_t bounce_count = 1;
  uint32_t sample_count = 1;    // rays of a rough surface at each bounce
  glm::vec3 environment{0.0F};  // linear light, where nothing is met
};

// Schlick's approximation: what a surface mirrors of light that comes to it at this cosine.
glm::vec3 fresnel(const glm::vec3& head_on, double cosine);

// Linear light along a ray: the surface's own, and what that mirrors.
glm::vec3 lightAlong(const Instant& instant, const Ray& ray, const MirrorOptions& options);

// Linear light through the middle of each px: [height][width], top row first.
std::vector<glm::vec3> takeMirrored(const Instant& instant, const Camera& view, SizePx view_px,
                                    const MirrorOptions& options);

inline constexpr uint8_t kNoMirror = kKnownCount;

struct SourceCamera {
  Camera camera;
  SizePx size_px;
};

// For each px that shows a mirror: the layer of a source that holds the mirrored thing, or why none
// does (truth::Known), the least of several; kNoMirror elsewhere, and where the first source does
// not see the mirror.
std::vector<uint8_t> mirroredKnownFrom(const Instant& instant,
                                       const std::vector<SourceCamera>& sources, const Camera& view,
                                       SizePx view_px);

}  // namespace viewloom::truth
