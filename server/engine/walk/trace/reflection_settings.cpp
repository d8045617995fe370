// SPDX-License-Identifier: Apache-2.0
#include "trace/reflection_settings.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "base/srgb.h"
#include "frame/cube_map.h"

namespace viewloom {
namespace {

// Position of a face in ReflectionSettings::recorded_as.
constexpr uint32_t kFaceShift = abi::kRecordFaceShift - abi::kRecordSourceShift;

float linearFromCode(uint32_t code) {
  return float(linearFromSrgb((code & 0xff) / 255.0));
}

// One of a job's walks: which source it is of, and which face of that.
struct SourceWalk {
  uint32_t source = 0;
  uint32_t face = 0;
  bool is_face = false;
};

SourceWalk sourceOf(const TraceJob& job, uint32_t walk) {
  const auto source =
      std::find_if(job.sources.begin(), job.sources.end(),
                   [&](const JobSource& each) { return walk < each.first_walk + each.walk_count; });
  return {uint32_t(source - job.sources.begin()), walk - source->first_walk, source->isCubeMap()};
}

// Between cameras' own spaces (y up, along -z) and those of kernels (y down, along z).
abi::vec3 flipped(const glm::dvec3& point) {
  return abi::vec3(glm::dvec3(point.x, -point.y, -point.z));
}

}  // namespace

abi::vec3 environmentOf(const ReflectionSpec& spec) {
  return {linearFromCode(spec.environment_rgb >> 16), linearFromCode(spec.environment_rgb >> 8),
          linearFromCode(spec.environment_rgb)};
}

abi::ReflectionSettings reflectionSettings(const StructureSlot& structure, const TraceJob& job,
                                           uint32_t walk, uint32_t first_walk) {
  const ReflectionSpec& spec = *job.reflection;
  const Pose own_from_first =
      compose(inverse(job.source_poses[walk]), job.source_poses[first_walk]);
  const SourceWalk own = sourceOf(job, walk);
  const glm::dquat own_from_source =
      own.is_face ? glm::inverse(cubeFaceOrientation(own.face)) : glm::dquat(1, 0, 0, 0);
  const auto axis = [](const glm::dquat& turn, double x, double y, double z) {
    return flipped(turn * glm::dvec3(x, y, z));
  };
  abi::ReflectionSettings settings{.surfaces = {},
                                   .environment = environmentOf(spec),
                                   .tolerance_px = float(job.tolerance_px),
                                   .bounce_count = spec.bounce_count,
                                   .sample_count = spec.sample_count,
                                   .walk = walk,
                                   .recorded_as = own.source | own.face << kFaceShift,
                                   .first_right = axis(own_from_first.orientation, 1, 0, 0),
                                   .first_down = axis(own_from_first.orientation, 0, -1, 0),
                                   .first_forward = axis(own_from_first.orientation, 0, 0, -1),
                                   .first_place = flipped(own_from_first.position_m),
                                   .source_right = axis(own_from_source, 1, 0, 0),
                                   .source_down = axis(own_from_source, 0, -1, 0),
                                   .source_forward = axis(own_from_source, 0, 0, -1)};
  if (structure.surface() == nullptr) return settings;
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    settings.surfaces[i] = addressWords(structure.surface()->address(i));
  }
  return settings;
}

}  // namespace viewloom
