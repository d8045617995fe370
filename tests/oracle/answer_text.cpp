// SPDX-License-Identifier: Apache-2.0
#include "oracle/answer_text.h"

#include <sstream>

namespace viewloom::oracle {

std::string describe(const OracleAnswer& answer) {
  std::ostringstream text;
  text << nameOf(answer.ray_class);
  if (!answer.hits.empty()) {
    const OracleHit& hit = answer.hits.front();
    text << (hit.is_back ? " of the back of layer " : " layer ") << hit.facet.layer << " at ("
         << hit.x_px << ", " << hit.y_px << ", " << hit.inv_z << ")";
  }
  return text.str();
}

std::string describe(const TestedAnswer& answer) {
  std::ostringstream text;
  text << nameOf(answer.ray_class);
  if (answer.ray_class == RayClass::kHit || answer.ray_class == RayClass::kHitAssumed) {
    text << (answer.is_back ? " of the back of layer " : " layer ") << answer.layer << " at ("
         << answer.x_px << ", " << answer.y_px << ", " << answer.inv_z << ")";
  }
  return text.str();
}

std::string describe(const Ray& ray) {
  std::ostringstream text;
  text.precision(17);
  text << "ray from (" << ray.origin_m.x << ", " << ray.origin_m.y << ", " << ray.origin_m.z
       << ") along (" << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z
       << ")";
  return text.str();
}

}  // namespace viewloom::oracle
