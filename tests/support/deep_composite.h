// SPDX-License-Identifier: Apache-2.0
// Composite of points that lie behind each other.
#pragma once

#include <span>

#include <glm/vec4.hpp>

#include "deep/deep_sample.h"

namespace viewloom::deep {

// Premultiplied.
inline glm::dvec4 compositeOf(std::span<const DeepPoint> points) {
  glm::dvec4 all(0);
  for (const DeepPoint& point : points) {
    all += (1 - all.a) * glm::dvec4(point.color, point.alpha);
  }
  return all;
}

}  // namespace viewloom::deep
