// SPDX-License-Identifier: Apache-2.0
// Reads from a photo's file which camera took it, what its colour is, and what its own depth means.
#pragma once

#include "base/status.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// Completes `result`. With a depth file of its own the photo is colour and camera alone, and the
// kind of input says what its depth is.
absl::Status interpretPhoto(const InputSettings& settings, const InputFiles& files,
                            Interpretation& result);

}  // namespace viewloom::inputs
