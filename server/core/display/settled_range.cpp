// SPDX-License-Identifier: Apache-2.0
#include "display/settled_range.h"

#include <algorithm>

namespace viewloom {

const InvZRange& SettledRange::settle(const InvZRange& measured) {
  const double margin = kMargin * measured.near;
  const bool stays = settled_.far <= measured.far && settled_.near >= measured.near &&
                     settled_.far >= measured.far - 2 * margin &&
                     settled_.near <= measured.near + 2 * margin;
  if (!stays) {
    settled_ = {.far = std::max(measured.far - margin, 0.0), .near = measured.near + margin};
  }
  return settled_;
}

}  // namespace viewloom
