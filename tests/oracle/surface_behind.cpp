// SPDX-License-Identifier: Apache-2.0
#include "oracle/surface_behind.h"

#include <algorithm>
#include <cmath>

namespace viewloom::oracle {

OracleAnswer behindFirst(const OracleSource& source, OracleAnswer answer) {
  if (answer.hits.empty()) return answer;
  const OracleHit first = answer.hits.front();
  const double apart = source.kappa().at(first.inv_z);
  const auto behind = std::find_if(answer.hits.begin(), answer.hits.end(), [&](const auto& hit) {
    return std::abs(hit.inv_z - first.inv_z) > apart;
  });
  answer.hits = {behind == answer.hits.end() ? first : *behind};
  answer.ray_class = RayClass::kHit;
  return answer;
}

}  // namespace viewloom::oracle
