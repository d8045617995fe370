// SPDX-License-Identifier: Apache-2.0
// What depth samples mean: every DepthFormat as coefficients that kernels turn to 1/Z.
#pragma once

#include <cstdint>
#include <string_view>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "frame/frame.h"

namespace viewloom {

// 1/m. What is nearer than a nanometre is no surface: so squares of 1/Z stay finite in binary32.
inline constexpr float kInvZMax = 1e9F;

// Every meaning in one formula for kernels, plain enough to upload as it is:
//   value = (sample - origin) * scale + offset        sample as stored, U16 as 0..65535
//   reciprocal == 0: 1/Z = value                      (kWindow, kDisparity)
//   reciprocal == 1: 1/Z = 1 / value, +inf gives 0    (kPlanar, kRayDistance)
//   ray_distance == 1: then times |((pixel + 0.5 - principal) / focal, 1)|
// Before that, sample == invalid_value (with has_invalid) is the sky when invalid_is_far, else no
// surface. NaN, negative and > inv_z_max are bad samples; value 0 with reciprocal is no surface.
// origin is the sample of the far end, so that an infinite far plane decodes to exactly 0.
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

// Expects a format that validateDepthFormat accepts.
DepthCoefficients makeDepthCoefficients(const DepthFormat& format, PlaneEncoding encoding);

// How far two surfaces of a column may be apart in 1/Z and still be one sample's worth: terms of
// step(w) = x + y w + z w^2, 1/m. A step of the stored number, carried through 1/Z = value or
// 1/Z = 1 / value.
glm::vec3 surfaceStep(const PlaneFormat& depth);

// Errors name the field relative to `field`, as in proto DepthFormat.
absl::Status validateDepthFormat(const DepthFormat& format, PlaneEncoding encoding,
                                 std::string_view field);

}  // namespace viewloom
