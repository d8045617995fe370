// SPDX-License-Identifier: Apache-2.0
#include "support/truth/mirrored.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace viewloom::truth {
namespace {

// So far in front of a mirror rays go on from it, m.
constexpr double kAbove_m = 1e-7;

double smithLambda(double cosine, double alpha) {
  const double tangent2 = 1 / (cosine * cosine) - 1;
  return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

// A microfacet's normal by its share of the surface (Walter et al. 2007), z the surface's normal.
// `place`: even in a unit square.
glm::dvec3 microfacet(double alpha, const glm::dvec2& place) {
  const double angle = 2 * std::numbers::pi * place.y;
  const double cosine = std::sqrt((1 - place.x) / (1 + (alpha * alpha - 1) * place.x));
  const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

glm::dvec3 around(const glm::dvec3& normal, const glm::dvec3& local) {
  const glm::dvec3 other = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(other, normal));
  return local.x * right + local.y * glm::cross(normal, right) + local.z * normal;
}

class Light {
 public:
  Light(const Instant& instant, const MirrorOptions& options)
      : instant_(instant), options_(options) {}

  glm::vec3 along(const Ray& ray, uint32_t bounce) {
    const HitColumn column = instant_.peel(ray, 1);
    if (column.count == 0) return options_.environment;
    const Hit& hit = column.hits.front();
    const glm::vec3 own = instant_.color(ray, hit);
    const Gloss gloss = instant_.gloss(hit);
    if (!gloss.mirrors() || bounce == options_.bounce_count) return own;
    const Ray unit{ray.origin_m + hit.depth * ray.direction, glm::normalize(ray.direction)};
    const uint32_t count = gloss.roughness > 0 ? options_.sample_count : 1;
    // A lattice, moved at random for each px: even, and its errors are no other px's.
    std::uniform_real_distribution<double> uniform(0, 1);
    const glm::dvec2 first(uniform(random_), uniform(random_));
    glm::vec3 sum(0.0F);
    for (uint32_t i = 0; i < count; ++i) {
      const glm::dvec2 place((i + first.x) / count, glm::fract(i / std::numbers::phi + first.y));
      sum += mirrored(unit, hit.normal, gloss, place, bounce);
    }
    return own + sum / static_cast<float>(count);
  }

 private:
  // `at`: from the place on the mirror, in the direction of who came there.
  glm::vec3 mirrored(const Ray& at, const glm::dvec3& normal, const Gloss& gloss,
                     const glm::dvec2& place, uint32_t bounce) {
    const double alpha = double{gloss.roughness} * double{gloss.roughness};
    const glm::dvec3 halfway = alpha > 0 ? around(normal, microfacet(alpha, place)) : normal;
    const double to_eye = -glm::dot(at.direction, halfway);
    const glm::dvec3 direction = at.direction + 2 * to_eye * halfway;
    const double cosine_in = glm::dot(direction, normal);
    const double cosine_out = -glm::dot(at.direction, normal);
    if (to_eye <= 0 || cosine_in <= 0 || cosine_out <= 0) return glm::vec3(0.0F);
    const Ray ray{at.origin_m + kAbove_m * normal, direction};
    const glm::vec3 light = fresnel(gloss.light, to_eye) * along(ray, bounce + 1);
    if (alpha == 0) return light;
    const double unshadowed =
        1 / (1 + smithLambda(cosine_in, alpha) + smithLambda(cosine_out, alpha));
    const double weight = unshadowed * to_eye / (cosine_out * halfwayCosine(halfway, normal));
    return static_cast<float>(weight) * light;
  }
  static double halfwayCosine(const glm::dvec3& halfway, const glm::dvec3& normal) {
    return glm::dot(halfway, normal);
  }

  const Instant& instant_;
  const MirrorOptions& options_;
  std::mt19937 random_{7};
};

}  // namespace

glm::vec3 fresnel(const glm::vec3& head_on, double cosine) {
  const auto rest = static_cast<float>(std::pow(1 - cosine, 5));
  return head_on + (1.0F - head_on) * rest;
}

glm::vec3 lightAlong(const Instant& instant, const Ray& ray, const MirrorOptions& options) {
  return Light(instant, options).along(ray, 0);
}

std::vector<glm::vec3> takeMirrored(const Instant& instant, const Camera& view, SizePx view_px,
                                    const MirrorOptions& options) {
  Light light(instant, options);
  std::vector<glm::vec3> picture;
  picture.reserve(view_px.area());
  for (uint32_t y = 0; y < view_px.height; ++y) {
    for (uint32_t x = 0; x < view_px.width; ++x) {
      picture.push_back(light.along(rayThrough(view, {x + 0.5, y + 0.5}), 0));
    }
  }
  return picture;
}

std::vector<uint8_t> mirroredKnownFrom(const Instant& instant,
                                       const std::vector<SourceCamera>& sources, const Camera& view,
                                       SizePx view_px) {
  const SourceCamera& first = sources.front();
  std::vector<uint8_t> known = knownFrom(instant, first.camera, first.size_px, view, view_px);
  for (size_t i = 0; i < known.size(); ++i) {
    const Ray ray =
        rayThrough(view, {double(i % view_px.width) + 0.5, double(i / view_px.width) + 0.5});
    const HitColumn column = instant.peel(ray, 1);
    const bool is_mirror = known[i] == 0 && instant.gloss(column.hits.front()).mirrors();
    if (!is_mirror) {
      known[i] = kNoMirror;
      continue;
    }
    const Hit& hit = column.hits.front();
    const Ray mirrored{ray.origin_m + hit.depth * ray.direction + kAbove_m * hit.normal,
                       glm::reflect(glm::normalize(ray.direction), hit.normal)};
    known[i] = kNoMirror;
    for (const SourceCamera& source : sources) {
      known[i] = std::min(known[i], knownAlong(instant, source.camera, source.size_px, mirrored));
    }
  }
  return known;
}

}  // namespace viewloom::truth
