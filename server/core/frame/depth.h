// SPDX-License-Identifier: Apache-2.0
// Converts every DepthFormat to coefficients, with which kernels turn samples into 1/Z.
#pragma once

#include <cstdint>
#include <string_view>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "frame/frame.h"

namespace viewloom {

// Largest 1/Z, 1/m. Nearer than a nanometre is no surface, so that squares of 1/Z stay finite in
// binary32.
inline constexpr float kInvZMax = 1e9F;

// Every meaning in one formula for kernels. It is uploaded unchanged:
//   value = (sample - origin) * scale + offset        sample as stored, U16 as 0..65535
//   reciprocal == 0: 1/Z = value                      (kWindow, kDisparity)
//   reciprocal == 1: 1/Z = 1 / value, +inf gives 0    (kPlanar, kRayDistance)
//   ray_distance == 1: then times |((pixel + 0.5 - principal) / focal, 1)|
// Before that, sample == invalid_value (with has_invalid) is the sky if invalid_is_far is set, else
// no surface. NaN, negative values and values over inv_z_max are bad samples. Value 0 with
// reciprocal is no surface. The origin is the sample of the far end: an infinite far plane decodes
// to exactly 0.
struct DepthCoefficients {
  float origin = 0;
  float scale = 1;
  float offset = 0;
  float invalid_value = 0;  // rounded to what the encoding can hold
  float inv_z_max = kInvZMax;
  uint32_t reciprocal = 0;
  uint32_t ray_distance = 0;
  uint32_t has_invalid = 0;
  uint32_t invalid_is_far = 0;
};

// Makes coefficients. Expects a format that validateDepthFormat accepts.
DepthCoefficients makeDepthCoefficients(const DepthFormat& format, PlaneEncoding encoding);

// Distance in 1/Z of two surfaces of a column that differ by one step of the stored number. Returns
// the terms of step(w) = x + y w + z w^2, 1/m, for 1/Z = value or 1/Z = 1 / value.
glm::vec3 surfaceStep(const PlaneFormat& depth);

// Checks a format. Errors name the field relative to `field`, as in proto DepthFormat.
absl::Status validateDepthFormat(const DepthFormat& format, PlaneEncoding encoding,
                                 std::string_view field);

}  // namespace viewloom
