// SPDX-License-Identifier: Apache-2.0
// Reads from an EXR file's header which tool wrote it, where its colour and depth are, and which
// camera saw them.
#pragma once

#include "base/status.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

// Completes `result`, whose kind is kAuto's kPlain, or what the settings demand. Colour, depth or
// both are EXR files. Channels that are not found stay open.
absl::Status interpretExr(const InputSettings& settings, const InputFiles& files,
                          Interpretation& result);

}  // namespace viewloom::inputs
