// SPDX-License-Identifier: Apache-2.0
#include "decode/pack_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/check.h"
#include "frame/limits.h"
#include "shared/surface_abi.h"

namespace viewloom {
namespace {

static_assert(sizeof(abi::SurfaceTexel) == kSurfaceTexelBytes);

// Shorter ones say nothing: three bytes in the middle of their range are 0.007 long.
constexpr float kNormalLengthMin = 0.05F;
constexpr float kOctSteps = 65535;

template <typename Word>
Word wordAt(const uint8_t* bytes) {
  Word word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

float signOf(float value) {
  return value < 0 ? -1.0F : 1.0F;
}

glm::vec3 fromOctahedron(glm::vec2 uv) {
  const float z = 1 - std::abs(uv.x) - std::abs(uv.y);
  if (z >= 0) return {uv, z};
  return {(1 - std::abs(uv.y)) * signOf(uv.x), (1 - std::abs(uv.x)) * signOf(uv.y), z};
}

uint32_t toOctahedron(const glm::vec3& normal) {
  const glm::vec3 on = normal / (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  const glm::vec2 folded((1 - std::abs(on.y)) * signOf(on.x), (1 - std::abs(on.x)) * signOf(on.y));
  const glm::vec2 uv = on.z >= 0 ? glm::vec2(on) : folded;
  const auto code = [](float value) {
    return uint32_t(std::lround((std::clamp(value, -1.0F, 1.0F) + 1) * (0.5F * kOctSteps)));
  };
  const uint32_t codes = code(uv.x) | code(uv.y) << 16;
  // All four corners are the same direction, and one of them says that there is none.
  return codes == abi::kNoNormal ? UINT32_MAX : codes;
}

glm::vec3 normalAt(PlaneEncoding encoding, const uint8_t* bytes) {
  if (encoding == PlaneEncoding::kXyz16f) {
    const auto half = [&](int i) { return glm::unpackHalf1x16(wordAt<uint16_t>(bytes + 2 * i)); };
    return {half(0), half(1), half(2)};
  }
  if (encoding == PlaneEncoding::kXyz8) {
    return glm::vec3(bytes[0], bytes[1], bytes[2]) * (2 / 255.0F) - 1.0F;
  }
  const glm::vec2 codes(wordAt<uint16_t>(bytes), wordAt<uint16_t>(bytes + 2));
  return fromOctahedron(codes * (2 / kOctSteps) - 1.0F);
}

uint64_t packNormals(const PlaneFormat& format, const SharedBytes& plane,
                     const glm::dquat& world_from_camera, abi::SurfaceTexel* to) {
  const size_t count = format.size_px.area();
  const size_t sample_bytes = plane->size() / count;
  const bool is_in_world = format.normal_space == NormalSpace::kWorld;
  const glm::mat3 turn =
      is_in_world ? glm::mat3(glm::mat3_cast(glm::inverse(world_from_camera))) : glm::mat3(1.0F);
  uint64_t bad_count = 0;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 normal = turn * normalAt(format.encoding, plane->data() + i * sample_bytes);
    const float length = std::sqrt(glm::dot(normal, normal));
    const bool is_good = length >= kNormalLengthMin && std::isfinite(length);
    to[i].normal = is_good ? toOctahedron(normal) : abi::kNoNormal;
    bad_count += is_good ? 0 : 1;
  }
  return bad_count;
}

}  // namespace

void addSurface(const LayerFormat& layer, const SurfacePlanes& planes,
                const glm::dquat& world_from_camera, BytePool& pool, LayerPlanes& to) {
  VIEWLOOM_CHECK(planes.specular != nullptr);
  const size_t count = layer.depth.size_px.area();
  BytePool::Buffer packed = pool.takeUncleared(count * sizeof(abi::SurfaceTexel));
  packed->resize(count * sizeof(abi::SurfaceTexel));
  auto* const texels = reinterpret_cast<abi::SurfaceTexel*>(packed->data());
  const size_t specular_bytes = planes.specular->size() / count;
  for (size_t i = 0; i < count; ++i) {
    const uint8_t* const specular = planes.specular->data() + i * specular_bytes;
    const bool is_grey = specular_bytes == 1;
    texels[i] = {.normal = abi::kNoNormal,
                 .light = uint32_t{specular[0]} | uint32_t{specular[is_grey ? 0 : 1]} << 8 |
                          uint32_t{specular[is_grey ? 0 : 2]} << 16 |
                          uint32_t{planes.roughness ? (*planes.roughness)[i] : uint8_t{0}} << 24};
  }
  if (planes.normal) {
    to.bad_normals_count =
        packNormals(*layer.find(PlaneKind::kNormal), planes.normal, world_from_camera, texels);
  }
  to.surface = std::move(packed);
}

}  // namespace viewloom
