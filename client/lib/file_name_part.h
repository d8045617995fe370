// SPDX-License-Identifier: Apache-2.0
// Parts of file names that come from outside.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// Whether a server's word may stand in the name of a file: up to 64 letters, digits, '_', '-', '.'.
bool isFileNamePart(std::string_view text);

// The text made fit to begin the name of a file: what could lead elsewhere, hide the file or pass
// for an option becomes '_', and it is cut to 128 bytes.
std::string fileNameFrom(std::string_view text);

}  // namespace viewloom
