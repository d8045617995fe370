// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "eye_poses/eye_track.h"

namespace viewloom {

// Nobody tracks eyes there.
class NoEyes final : public EyeSink {
 public:
  void serveEyes(uint64_t /*display_id*/) override {}
};

}  // namespace viewloom
