// SPDX-License-Identifier: Apache-2.0
// Says whether a tested answer differs from the oracle's: only where a moved ray could not excuse
// it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oracle/view_generator.h"

namespace viewloom::oracle {

// Answer of a tracer under test to a ray; layer and position count for hits alone.
struct TestedAnswer {
  RayClass ray_class = RayClass::kOutside;
  int layer = -1;
  double x_px = 0;
  double y_px = 0;
  double inv_z = 0;
  bool is_back = false;  // OracleHit::is_back
};

struct JudgeTolerance {
  double output_px = 0.25;  // how far a picture may be off: the tolerance the display asked for
  double source_px = 0;     // rounding of an image position in the source
  double inv_z = 0;         // rounding of 1/Z, 1/m
};

// Rounding of a tracer that computes in binary32: this many units in the last place of the largest
// coordinate (the image's size in px, the largest 1/Z of the source).
JudgeTolerance toleranceOf(const OracleSource& source, double output_px);

// Counts of rays. exact + within + excused + differing = rays.
struct Verdict {
  static constexpr size_t kWorstCount = 6;

  uint64_t rays = 0;
  uint64_t exact = 0;    // the oracle's own answer, up to rounding
  uint64_t within = 0;   // the answer of the ray, or its surface, moved by less than the tolerance
  uint64_t excused = 0;  // not the oracle's, but the moved rays do not agree with each other either
  uint64_t differing = 0;          // the moved rays all agree, and not with it
  std::vector<std::string> worst;  // the first kWorstCount differing rays, in words

  void add(const Verdict& other);
  double excusedShare() const { return rays == 0 ? 0 : double(excused) / double(rays); }
  std::string summary() const;
};

// Which surface a ray is asked for: the first, or what stands behind it (surface_behind.h).
enum class AskedSurface { kFirst, kBehind };

// Thread-safety: none.
class Judge {
 public:
  Judge(const OracleSource& source, const JudgeTolerance& tolerance,
        AskedSurface asked = AskedSurface::kFirst)
      : source_(source), tolerance_(tolerance), asked_(asked) {}

  // `where` names the ray in messages.
  void consider(const ViewRay& ray, const TestedAnswer& tested, const std::string& where);
  // Considers a ray that goes on from a surface of this layer (traceFromSurface).
  void considerFrom(int surface_layer, const ViewRay& ray, const TestedAnswer& tested,
                    const std::string& where);
  const Verdict& verdict() const { return verdict_; }

 private:
  template <typename AnyRay>
  OracleAnswer answerOf(const AnyRay& ray) const;
  OracleAnswer answerFrom(const ProjectedRay& ray) const;
  OracleAnswer answerFrom(const Ray& ray) const;
  bool matches(const OracleAnswer& oracle, const TestedAnswer& tested) const;
  std::vector<OracleAnswer> answersOfMovedRays(const ViewRay& ray) const;
  bool agreeing(const std::vector<OracleAnswer>& answers) const;
  double invZTolerance(const ViewRay& ray, const TestedAnswer& tested) const;
  std::array<glm::dvec3, 2> pointsOf(const ProjectedRay& ray) const;
  bool liesOn(const ProjectedRay& ray, const glm::dvec3& position) const;
  bool skims(const OracleAnswer& own, const ViewRay& ray, const TestedAnswer& tested) const;
  bool standsThere(const TestedAnswer& tested, double inv_z_tolerance) const;
  bool amongThem(const std::vector<OracleAnswer>& answers, const ViewRay& ray,
                 const TestedAnswer& tested) const;

  const OracleSource& source_;
  const JudgeTolerance tolerance_;
  const AskedSurface asked_;
  std::optional<int> surface_layer_;  // that the ray under judgement goes on from
  Verdict verdict_;
};

// Whether two facets belong to one surface: linked column by column on the way from one to the
// other.
bool onOneSurface(const OracleSource& source, const FacetAt& a, const FacetAt& b);

}  // namespace viewloom::oracle
