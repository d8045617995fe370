// SPDX-License-Identifier: Apache-2.0
#include "trace/albedos.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/packing.hpp>

#include "shared/reflection_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

// A lattice of so many microfacets, of two successive Fibonacci numbers: a and b are off by no more
// than 0.002 at the places of the table (rough_mirrors_test).
constexpr uint32_t kMicrofacets = 377;
constexpr uint32_t kTurn = 233;
// Surfaces are not seen from along them, nor is any as smooth as a mirror.
constexpr float kCosineMin = 1e-3F;
constexpr float kRoughnessMin = 1e-2F;

// a and b.
abi::vec2 albedoParts(float cosine, float roughness) {
  const float alpha = roughness * roughness;
  const abi::vec3 towards(std::sqrt(1 - cosine * cosine), 0, cosine);
  abi::vec2 sum(0);
  for (uint32_t i = 0; i < kMicrofacets; ++i) {
    const abi::vec2 place((float(i) + 0.5F) / kMicrofacets,
                          (float(i * kTurn % kMicrofacets) + 0.5F) / kMicrofacets);
    const abi::vec3 halfway = abi::visibleNormal(towards, alpha, place);
    const float cosine_half = glm::dot(towards, halfway);
    const float cosine_in = 2 * cosine_half * halfway.z - cosine;
    if (cosine_in <= 0) continue;  // nothing is mirrored from below
    const float passed = abi::unshadowed(cosine_in, cosine, alpha);
    sum += passed * abi::vec2(1, abi::fresnelRest(cosine_half));
  }
  return sum / float(kMicrofacets);
}

AlbedoTable makeTable() {
  constexpr float kLast = abi::kAlbedoSteps - 1;
  AlbedoTable table{};
  for (uint32_t i = 0; i < table.size(); ++i) {
    const float root = float(i % abi::kAlbedoSteps) / kLast;
    const float roughness = float(i / abi::kAlbedoSteps) / kLast;
    table[i] = glm::packUnorm2x16(
        albedoParts(std::max(root * root, kCosineMin), std::max(roughness, kRoughnessMin)));
  }
  return table;
}

}  // namespace

const AlbedoTable& albedoTable() {
  static const AlbedoTable table = makeTable();
  return table;
}

Descriptor Albedos::descriptor() {
  std::call_once(is_there_, [this] {
    buffer_ = Buffer(*device_, {.size_bytes = sizeof(AlbedoTable),
                                .intent = MemoryIntent::kUpload,
                                .debug_name = "albedos"});
    std::memcpy(buffer_.mapped().data(), albedoTable().data(), sizeof(AlbedoTable));
  });
  return wholeBuffer(abi::kBindingAlbedos, buffer_);
}

}  // namespace viewloom
