// SPDX-License-Identifier: Apache-2.0
// Says what to do about EXR files whose colour or depth was not found.
#pragma once

#include "base/status.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// INVALID_ARGUMENT with the channels of the file and the options that choose when the colour or the
// depth of an EXR file was not found.
absl::Status requireExrChannels(const InputFiles& files, const Interpretation& how);

}  // namespace viewloom::inputs
