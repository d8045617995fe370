// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewloom/v1/display_service.pb.h"

namespace viewloom::test {

// Sum of the shares of reflected rays over all endings: 1, or 0 without mirrors.
inline double reflectedShare(const v1::AtlasEnd& end) {
  const v1::ReflectionShares& shares = end.reflections();
  return shares.hit() + shares.assumed() + shares.back() + shares.cube() + shares.environment();
}

}  // namespace viewloom::test
