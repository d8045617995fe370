// SPDX-License-Identifier: Apache-2.0
// Output cameras around a source, and their rays with the change of each ray per output pixel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "oracle/oracle_trace.h"
#include "oracle/scene_generator.h"

namespace viewloom::oracle {

// A pinhole in the source's camera space.
struct OutputView {
  std::string name;
  glm::dvec3 position_m{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z: view to source
  Pinhole pinhole;
  int width = 1;
  int height = 1;
};

// A ray and how its direction changes when the picture moves by one output pixel.
struct ViewRay {
  Ray ray;
  glm::dvec3 direction_per_px_x{0.0};
  glm::dvec3 direction_per_px_y{0.0};

  // The ray of the picture moved by so many output px.
  Ray movedBy(double x_px, double y_px) const;
};

// The ray through an image position of the view, px; pixel centres lie at +0.5.
ViewRay rayOf(const OutputView& view, double x_px, double y_px);

// The source's own camera.
OutputView ownView(const Scene& scene);

constexpr int kViewKindCount = 10;

// Kinds below this neither leave the source's plane nor turn: an atlas of them alone is what most
// displays ask for, and has a kernel of its own.
constexpr int kInPlaneKindCount = 3;

// Beside, above, before, behind, turned, looking sideways and backwards, inside the volume, across:
// kind in [0, kViewKindCount).
OutputView randomView(Random& random, int kind, int width, int height);

// A view of each kind below `kind_count`.
std::vector<OutputView> randomViews(Random& random, int kind_count, int width, int height);

}  // namespace viewloom::oracle
