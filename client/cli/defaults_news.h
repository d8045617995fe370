// SPDX-License-Identifier: Apache-2.0
// Says when a stream's defaults, and with them a display, have changed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "viewloom/v1/display_service.pb.h"

namespace viewloom::cli {

// Thread-safety: none; one owner.
class DefaultsNews {
 public:
  // The next atlas, and what its display takes from the stream ("focal plane at 2 m"). Empty while
  // that stays, or moves for other reasons.
  std::optional<std::string> note(const v1::AtlasHeader& header, const std::string& taken);

 private:
  uint64_t count_ = 0;  // of the newest atlas; 0 = none yet
  std::string taken_;
};

}  // namespace viewloom::cli
