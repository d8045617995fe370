// SPDX-License-Identifier: Apache-2.0
#include "oracle/view_generator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewloom::oracle {
namespace {

constexpr double kPi = std::numbers::pi;

// The scenes lie between about 0.5 and 20 m; the eyes move within this.
constexpr double kReach_m = 0.8;

glm::dquat turned(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, glm::normalize(axis));
}

const glm::dvec3 kUp{0, 1, 0};
const glm::dvec3 kRight{1, 0, 0};

}  // namespace

Ray ViewRay::movedBy(double x_px, double y_px) const {
  return {ray.origin_m, ray.direction + x_px * direction_per_px_x + y_px * direction_per_px_y};
}

ViewRay rayOf(const OutputView& view, double x_px, double y_px) {
  const Pinhole& p = view.pinhole;
  const glm::dvec3 in_view{(x_px - p.principal_px.x) / p.focal_px.x,
                           -(y_px - p.principal_px.y) / p.focal_px.y, -1.0};
  return {{view.position_m, view.orientation * in_view},
          view.orientation * glm::dvec3(1 / p.focal_px.x, 0, 0),
          view.orientation * glm::dvec3(0, -1 / p.focal_px.y, 0)};
}

OutputView ownView(const Scene& scene) {
  return {"own pose",    glm::dvec3(0.0),    glm::dquat(1.0, 0.0, 0.0, 0.0),
          scene.pinhole, scene.planes.width, scene.planes.height};
}

OutputView randomView(Random& random, int kind, int width, int height) {
  OutputView view;
  view.width = width;
  view.height = height;
  const double angle_of_view_rad = random.uniform(0.3, 1.2);
  const double focal_px = 0.5 * std::max(width, height) / std::tan(0.5 * angle_of_view_rad);
  view.pinhole = {{focal_px, focal_px},
                  {width * random.uniform(0.4, 0.6), height * random.uniform(0.4, 0.6)}};
  const auto move = [&] { return random.uniform(-kReach_m, kReach_m); };
  const auto place = [&] { return glm::dvec3(move(), move(), move()); };
  switch (kind) {
    case 0:
      view.name = "beside";
      view.position_m = {move(), 0, 0};
      break;
    case 1:
      view.name = "above";
      view.position_m = {0, move(), 0};
      break;
    case 2:
      view.name = "beside and above";
      view.position_m = {move(), move(), 0};
      break;
    case 3:
      view.name = "before or behind";
      view.position_m = {0, 0, move()};
      break;
    case 4:
      view.name = "turned";
      view.position_m = place();
      view.orientation = turned(place() + glm::dvec3(0, 0, 1), random.uniform(-0.6, 0.6));
      break;
    case 5:
      view.name = "sideways";
      view.position_m = place() - glm::dvec3(0, 0, random.uniform(0, 4));
      view.orientation = turned(kUp, random.chance(0.5) ? kPi / 2 : -kPi / 2);
      break;
    case 6:
      view.name = "upwards or downwards";
      view.position_m = place() - glm::dvec3(0, 0, random.uniform(0, 4));
      view.orientation = turned(kRight, random.chance(0.5) ? kPi / 2 : -kPi / 2);
      break;
    case 7:
      view.name = "towards the camera";
      view.position_m = place() - glm::dvec3(0, 0, random.uniform(1, 30));
      view.orientation = turned(kUp, kPi + random.uniform(-0.2, 0.2));
      break;
    case 8:
      view.name = "inside the volume";
      view.position_m = place() - glm::dvec3(0, 0, random.uniform(0.5, 10));
      view.orientation = turned(place(), random.uniform(-kPi, kPi));
      break;
    default:
      view.name = "across";
      view.position_m = glm::dvec3(3 * move(), 3 * move(), -random.uniform(0, 6));
      view.orientation = turned(kUp, (view.position_m.x > 0 ? 1 : -1) * random.uniform(0.8, 2.4));
      break;
  }
  return view;
}

std::vector<OutputView> randomViews(Random& random, int kind_count, int width, int height) {
  std::vector<OutputView> views;
  for (int kind = 0; kind < kind_count; ++kind) {
    views.push_back(randomView(random, kind, width, height));
  }
  return views;
}

}  // namespace viewloom::oracle
