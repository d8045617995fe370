// SPDX-License-Identifier: Apache-2.0
// The types that C++ and GLSL both know. Only 4-byte scalars and their vectors; buffers are scalar
// layout.
#ifndef VIEWLOOM_SHADERS_SHARED_GPU_TYPES_H_
#define VIEWLOOM_SHADERS_SHARED_GPU_TYPES_H_

#ifdef __cplusplus
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace viewloom::abi {

using uint = uint32_t;
using Address = glm::uvec2;  // a buffer device address: x = low, y = high 32 bits
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using std::pow;

#define VIEWLOOM_ABI_BEGIN namespace viewloom::abi {
#define VIEWLOOM_ABI_END }
#define VIEWLOOM_ABI_CONST inline constexpr
#define VIEWLOOM_ABI_FUNCTION inline constexpr
#define VIEWLOOM_ABI_INLINE inline
// A value whose operations are rounded one by one.
#define VIEWLOOM_ABI_PRECISE

constexpr uint floatBitsToUint(float value) {
  return std::bit_cast<uint>(value);
}
constexpr float uintBitsToFloat(uint bits) {
  return std::bit_cast<float>(bits);
}

}  // namespace viewloom::abi
#else
#define Address uvec2
#define VIEWLOOM_ABI_BEGIN
#define VIEWLOOM_ABI_END
#define VIEWLOOM_ABI_CONST const
#define VIEWLOOM_ABI_FUNCTION
#define VIEWLOOM_ABI_INLINE
#define VIEWLOOM_ABI_PRECISE precise
#endif

#endif  // VIEWLOOM_SHADERS_SHARED_GPU_TYPES_H_
