// SPDX-License-Identifier: Apache-2.0
// Reads from the header of a deep EXR file which px it has and which camera saw them.
#pragma once

#include "base/status.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// What the header of a deep file says: its window and its camera. Fills in `deep`.
absl::StatusOr<Interpretation> interpretDeep(const InputSettings& settings, v1::DeepFile& deep);

}  // namespace viewloom::inputs
