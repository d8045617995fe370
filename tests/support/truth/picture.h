// SPDX-License-Identifier: Apache-2.0
// Pictures of a pinhole camera at an instant, layer by layer: the true pictures.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "frame/camera.h"
#include "frame/size.h"
#include "support/truth/scene.h"

namespace viewloom::truth {

// The ray through a place of the image, px. Its depths are planar metres.
Ray rayThrough(const Camera& camera, const glm::dvec2& at_px);

// How the light of a px is measured. Everything else is that of the px's centre.
enum class ColorOver : uint8_t {
  kCenter,  // the surface at the px's centre
  // The mean over the px, as an antialiasing renderer takes it: in the first layer of whatever is
  // seen, in deeper ones of the surface at the centre alone.
  kArea,
};

struct PictureOptions {
  SizePx size_px;
  uint32_t layer_count = 1;  // 1..kLayersMax
  ColorOver color = ColorOver::kArea;
};

inline constexpr uint32_t kNoBody = kSky - 1;

// Layer k holds, per px, the k-th surface along the ray through its centre that faces the camera.
// All planes: [height][width], top row first.
struct PictureLayer {
  std::vector<glm::vec3> color;       // linear light, 0..1
  std::vector<float> depth_m;         // planar; +inf = sky, 0 = no such surface
  std::vector<glm::vec3> normal;      // world, unit length; 0 = sky or no surface
  std::vector<glm::vec3> motion_mps;  // world
  std::vector<Gloss> gloss;
  std::vector<uint32_t> body;     // index in the scene, kSky or kNoBody
  std::vector<uint8_t> is_mixed;  // 1 where the light is not of this body alone
};

struct Picture {
  Camera camera;
  SizePx size_px;
  std::vector<PictureLayer> layers;
};

Picture takePicture(const Instant& instant, const Camera& camera, const PictureOptions& options);

}  // namespace viewloom::truth
