// SPDX-License-Identifier: Apache-2.0
#include "oracle/cube_judge.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <glm/geometric.hpp>

#include "oracle/nearby.h"
#include "oracle/plane_error.h"

namespace viewloom::oracle {
namespace {

// A chain of binary32 from the ray to the place of its hit, a share of 1/Z.
constexpr double kInvZShareTolerance = 1e-3;

double invZIn(const ViewRay& ray, const CubeAnswer& answer) {
  return glm::length(ray.ray.direction) / answer.distance_m;
}

}  // namespace

CubeJudge::CubeJudge(const OracleCube& cube, double output_px)
    : cube_(cube), output_px_(output_px) {
  for (const OracleSource& face : cube.faces) tolerances_.push_back(toleranceOf(face, output_px));
}

// Answers to the ray, to the rays of a picture moved by its tolerance, and of a face with rounding,
// or with surfaces off by an amount that moves the picture by its tolerance. Whichever face
// answers, another's surface may be off, and is hit for that or missed.
std::vector<CubeAnswer> CubeJudge::answersNearby(const ViewRay& ray,
                                                 const TestedCubeAnswer& tested) const {
  std::vector<CubeAnswer> nearby = {traceCube(cube_, ray.ray)};
  for (const glm::dvec2& move_px : movesWithin(output_px_)) {
    nearby.push_back(traceCube(cube_, ray.movedBy(move_px.x, move_px.y)));
  }
  std::vector<double> view_inv_zs;
  if (isHit(nearby.front().ray_class)) view_inv_zs.push_back(invZIn(ray, nearby.front()));
  if (isHit(tested.ray_class)) view_inv_zs.push_back(tested.view_inv_z);
  for (int face = 0; face < kFaceCount; ++face) {
    const JudgeTolerance& tolerance = tolerances_[size_t(face)];
    const double plane = planeErrorAt({&cube_.faces[size_t(face)], cube_.kappas[size_t(face)]},
                                      seenFromFace(face, ray), view_inv_zs, output_px_);
    for (const double sign : {-1.0, 1.0}) {
      for (const glm::dvec3& step :
           {glm::dvec3(tolerance.source_px, 0, 0), glm::dvec3(0, tolerance.source_px, 0),
            glm::dvec3(0, 0, tolerance.inv_z), glm::dvec3(0, 0, plane),
            glm::dvec3(0, 0, 0.5 * plane), glm::dvec3(0, 0, 0.25 * plane)}) {
        nearby.push_back(traceCube(cube_, ray.ray, {face, sign * step}));
      }
    }
  }
  return nearby;
}

void CubeJudge::consider(const ViewRay& ray, const TestedCubeAnswer& tested,
                         const std::string& where) {
  ++verdict_.rays;
  const CubeAnswer own = traceCube(cube_, ray.ray);
  const bool is_hit = isHit(own.ray_class);
  const double own_inv_z = is_hit ? invZIn(ray, own) : 0;
  const bool is_near =
      !is_hit || std::abs(tested.view_inv_z - own_inv_z) <= kInvZShareTolerance * own_inv_z;
  if (tested.ray_class == own.ray_class && is_near) {
    ++verdict_.exact;
    return;
  }
  const std::vector<CubeAnswer> nearby = answersNearby(ray, tested);
  Range inv_z;
  bool all_agree = true;
  for (const CubeAnswer& answer : nearby) {
    all_agree = all_agree && answer.ray_class == own.ray_class;
    if (isHit(answer.ray_class)) inv_z.include(invZIn(ray, answer));
  }
  if (!all_agree) {
    ++verdict_.excused;
    return;
  }
  if (tested.ray_class == own.ray_class &&
      inv_z.holds(tested.view_inv_z, kInvZShareTolerance * inv_z.high)) {
    ++verdict_.within;
    return;
  }
  ++verdict_.differing;
  if (verdict_.worst.size() >= Verdict::kWorstCount) return;
  std::ostringstream text;
  text << where << ": oracle " << own.ray_class << " at " << own_inv_z << " 1/m on face "
       << own.face << " (" << own.hit.x_px << ", " << own.hit.y_px << "), tested "
       << tested.ray_class << " at " << tested.view_inv_z;
  verdict_.worst.push_back(text.str());
}

}  // namespace viewloom::oracle
