// SPDX-License-Identifier: Apache-2.0
// Where the atlases of a subscriber are recorded.
#pragma once

#include <string>

#include "base/status.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Thread-safety: none; one owner at a time.
class AtlasTarget {
 public:
  virtual ~AtlasTarget() = default;

  // A message that comes now. FAILED_PRECONDITION when the disk takes no more.
  virtual absl::Status add(const v1::StreamAtlasesResponse& message) = 0;
  // Whether an atlas has begun and not ended.
  virtual bool isWithinAtlas() const = 0;
  // Puts the file in its place, also after add() failed. FAILED_PRECONDITION when nothing whole
  // came, or the file cannot be written. Call once.
  virtual absl::Status complete() = 0;
  // Result for users: "FILE: 12 atlases recorded".
  virtual std::string summary() const = 0;
};

}  // namespace viewloom
