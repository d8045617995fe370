// SPDX-License-Identifier: Apache-2.0
// Which options count for which kind of input: what is given in vain is refused.
#pragma once

#include "base/status.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// INVALID_ARGUMENT with an option that was given, the kind that does not use it, and what does.
absl::Status refuseUnusedOptions(const InputSettings& settings, const InputFiles& files,
                                 const Interpretation& how);

}  // namespace viewloom::inputs
