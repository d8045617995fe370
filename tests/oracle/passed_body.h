// SPDX-License-Identifier: Apache-2.0
// Fate of a ray behind the body that it passes behind first, by the definition in
// shaders/reflections.md.
#pragma once

#include "oracle/oracle_source.h"

namespace viewloom::oracle {

enum class BehindBody {
  kUnknown,  // the body is not seen from rim to rim
  kPassed,
  kMet
};

struct BodyAnswer {
  BehindBody behind = BehindBody::kUnknown;
  glm::dvec3 place{0.0};  // where the body is met: x px, y px, inv_z

  bool agrees(const BodyAnswer& other, double tolerance_px) const;
};

// Answer for a ray from its beginning, by the place where it passed behind something, across an
// edge between two columns, to its end: x px, y px, inv_z.
BodyAnswer behindBody(const OracleSource& source, const glm::dvec3& begin, const glm::dvec3& passed,
                      const glm::dvec3& end);

}  // namespace viewloom::oracle
