// SPDX-License-Identifier: Apache-2.0
// Numbers as a command line takes them.
#pragma once

#include <string>

namespace viewloom::inspect {

// The shortest text that reads back as the same number: "0.001", "1e+30", "inf".
std::string numberText(double number);
std::string numberText(float number);

}  // namespace viewloom::inspect
