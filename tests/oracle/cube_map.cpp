// SPDX-License-Identifier: Apache-2.0
#include "oracle/cube_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace viewloom::oracle {
namespace {

// Value of the definition: shaders/structure.md and shaders/walk.md.
constexpr double kSeamOverlap_px = 1.0 / 64;
constexpr double kSeam_px = 1 - 1.0 / 64;
constexpr double kSeamShare = 1e-4;
constexpr double kAtEye_m = 0x1p-30;

// Where a px lies at an edge between two samples, rounding does not decide which is the nearest.
constexpr double kRounding_px = 1e-9;

struct Directions {
  glm::dvec3 right, up, forward;
};

constexpr Directions kDirections[kFaceCount] = {
    {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},  {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};

// The column of a face's apron, px of the whole image.
void fillColumn(const FacePlanes& faces, const std::vector<OracleSource>& sources, int face,
                int column, int row, InvZPlanes& whole) {
  const int side = faces[0].width;
  const auto tangent = [&](int px) { return 2 * (px - kApron_px + 0.5) / side - 1; };
  const Directions& own = kDirections[face];
  const glm::dvec3 direction = own.forward + tangent(column) * own.right - tangent(row) * own.up;
  int other = 0;
  for (int i = 1; i < kFaceCount; ++i) {
    // At a corner, the one of the two to the side.
    const double slack = glm::dot(kDirections[i].forward, own.right) != 0 ? 1e-12 : -1e-12;
    if (glm::dot(direction, kDirections[i].forward) + slack >
        glm::dot(direction, kDirections[other].forward)) {
      other = i;
    }
  }
  const Directions& its = kDirections[other];
  const double depth = glm::dot(direction, its.forward);
  const double x_px = 0.5 * side * (1 + glm::dot(direction, its.right) / depth);
  const double y_px = 0.5 * side * (1 - glm::dot(direction, its.up) / depth);
  const int i = std::clamp(int(std::floor(x_px + kRounding_px)), 0, side - 1);
  const int j = std::clamp(int(std::floor(y_px + kRounding_px)), 0, side - 1);
  const float offset_x = float(x_px - i) - 0.5F;
  const float offset_y = float(y_px - j) - 0.5F;
  float before = std::numeric_limits<float>::max();
  for (int layer = 0; layer < whole.layer_count; ++layer) {
    const FacetAt at{layer, i, j};
    const float inv_z = faces[size_t(other)].at(layer, i, j);
    if (inv_z < 0) continue;
    const OracleSource& source = sources[size_t(other)];
    const float bent = source.slope(at, 1, 0) * offset_x + source.slope(at, 0, 1) * offset_y;
    before = std::min(std::max(inv_z + bent, 0.0F) * float(depth), before);
    whole.at(layer, column, row) = before;
  }
}

// The part of a ray that a face is asked about.
struct FaceStretch {
  int face = 0;
  ProjectedRay ray;
  double own_begin = 0;
  SeenPart seen;
  OracleAnswer answer;
};

// Sides of a square in the image as linear functions of homogeneous points.
std::array<double, 4> insideOf(const HomogeneousPoint& p, double low_px, double high_px) {
  return {p.u - low_px * p.z, p.v - low_px * p.z, high_px * p.z - p.u, high_px * p.z - p.v};
}

// Rays begin so much before the nearest that was measured.
constexpr double kNearMargin = 1.0001;

std::optional<FaceStretch> stretchIn(const OracleSource& source, double nearest_inv_z,
                                     const ProjectedRay& ray) {
  double own_begin = 0, own_end = 1, end = 1;
  const auto enter = [](double a, double b, double& begin) {
    if (a < 0) begin = b <= 0 ? 2 : std::max(begin, a / (a - b));
  };
  const auto leave = [](double a, double b, double& at) {
    if (b < 0) at = a < 0 ? -1 : std::min(at, a / (a - b));
  };
  const double own_px = kApron_px - kSeamOverlap_px, seam_px = kApron_px - kSeam_px;
  const double whole_px = source.width();
  const auto own_a = insideOf(ray.a, own_px, whole_px - own_px);
  const auto own_b = insideOf(ray.b, own_px, whole_px - own_px);
  const auto seam_a = insideOf(ray.a, seam_px, whole_px - seam_px);
  const auto seam_b = insideOf(ray.b, seam_px, whole_px - seam_px);
  for (size_t side = 0; side < 4; ++side) {
    enter(own_a[side], own_b[side], own_begin);
    leave(own_a[side], own_b[side], own_end);
    leave(seam_a[side], seam_b[side], end);
  }
  double begin = own_begin;
  const double near_inv_z = kNearMargin * nearest_inv_z;
  enter(near_inv_z * ray.a.z - ray.a.h, near_inv_z * ray.b.z - ray.b.h, begin);
  leave(near_inv_z * ray.a.z - ray.a.h, near_inv_z * ray.b.z - ray.b.h, end);
  if (!(own_begin < own_end && begin < end)) return std::nullopt;
  const bool is_at_eye = own_begin <= kAtEye_m;  // there, s is metres
  return FaceStretch{
      .ray = ray, .own_begin = is_at_eye ? 0 : own_begin, .seen = {begin, end, end == 1}};
}

double distanceOf(double s) {
  return s / (1 - s);  // the oracle's directions have length 1
}

double firstHit(const OracleAnswer& answer) {
  return answer.hits.empty() ? 2 : answer.hits.front().s;
}

bool isInSeam(const OracleHit& hit, int side_px) {
  const double low_px = kApron_px - kSeamOverlap_px;
  const double high_px = side_px + kApron_px + kSeamOverlap_px;
  return std::min(hit.x_px, hit.y_px) < low_px || std::max(hit.x_px, hit.y_px) > high_px;
}

}  // namespace

FacePlanes withAprons(const FacePlanes& faces) {
  std::vector<OracleSource> sources;
  for (const InvZPlanes& planes : faces) {
    sources.emplace_back(planes, Pinhole{}, ConnectionTolerance{});
  }
  const int side = faces[0].width, whole = side + 2 * kApron_px;
  FacePlanes result;
  for (int face = 0; face < kFaceCount; ++face) {
    InvZPlanes& planes = result[size_t(face)];
    planes = makePlanes(whole, whole, faces[0].layer_count);
    for (int row = 0; row < whole; ++row) {
      for (int column = 0; column < whole; ++column) {
        const int i = column - kApron_px, j = row - kApron_px;
        if (std::min(i, j) < 0 || std::max(i, j) >= side) {
          fillColumn(faces, sources, face, column, row, planes);
          continue;
        }
        for (int layer = 0; layer < planes.layer_count; ++layer) {
          planes.at(layer, column, row) = faces[size_t(face)].at(layer, i, j);
        }
      }
    }
  }
  return result;
}

glm::dquat faceOrientation(int face) {
  const Directions& d = kDirections[face];
  return glm::normalize(glm::quat_cast(glm::dmat3(d.right, d.up, -d.forward)));
}

Pinhole facePinhole(int side_px) {
  return {glm::dvec2(0.5 * side_px), glm::dvec2(0.5 * side_px + kApron_px)};
}

ViewRay seenFromFace(int face, const ViewRay& ray) {
  const glm::dquat back = glm::conjugate(faceOrientation(face));
  return {{back * ray.ray.origin_m, back * ray.ray.direction},
          back * ray.direction_per_px_x,
          back * ray.direction_per_px_y};
}

CubeAnswer traceCube(const OracleCube& cube, const Ray& ray, const FaceMove& move) {
  std::vector<FaceStretch> stretches;
  for (int face = 0; face < kFaceCount; ++face) {
    const OracleSource& source = cube.faces[size_t(face)];
    std::optional<FaceStretch> stretch =
        stretchIn(source, cube.nearest_inv_z[size_t(face)],
                  projectRay(source.pinhole(), seenFromFace(face, {ray}).ray));
    if (!stretch) continue;
    stretch->face = face;
    const ProjectedRay moved =
        move.face == face ? movedBy(stretch->ray, move.by.x, move.by.y, move.by.z) : stretch->ray;
    stretch->answer = traceOracle(source, moved, stretch->seen);
    stretches.push_back(*std::move(stretch));
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const auto& a, const auto& b) { return a.own_begin < b.own_begin; });
  CubeAnswer result;
  bool was_behind = false;
  for (size_t i = 0; i < stretches.size(); ++i) {
    const OracleAnswer& answer = stretches[i].answer;
    const FaceStretch* const next = i + 1 < stretches.size() ? &stretches[i + 1] : nullptr;
    result.face = stretches[i].face;
    if (!answer.hits.empty()) {
      const OracleHit& hit = answer.hits.front();
      const bool counts = next == nullptr || !isInSeam(hit, cube.sidePx()) ||
                          (next->answer.passed_s <= hit.s && firstHit(next->answer) > hit.s);
      if (counts) {
        const bool is_assumed = was_behind || hit.assumed;
        result.ray_class = is_assumed ? RayClass::kHitAssumed : RayClass::kHit;
        result.distance_m = distanceOf(hit.s);
        result.hit = hit;
        return result;
      }
    }
    result.ray_class = answer.ray_class == RayClass::kHidden ? RayClass::kHidden : RayClass::kEmpty;
    const double passed_m =
        answer.passed_s < 1 ? distanceOf(answer.passed_s) : std::numeric_limits<double>::infinity();
    const double next_m =
        next != nullptr ? distanceOf(next->own_begin) : std::numeric_limits<double>::infinity();
    was_behind = was_behind || passed_m * (1 + kSeamShare) < next_m;
  }
  return result;
}

}  // namespace viewloom::oracle
