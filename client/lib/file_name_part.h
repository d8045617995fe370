// SPDX-License-Identifier: Apache-2.0
// File names made from foreign text.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// Whether a text may be part of a file name: up to 64 letters, digits, '_', '-', '.'.
bool isFileNamePart(std::string_view text);

// Makes the beginning of a file name from a text. Characters that could lead to another folder,
// hide the file or look like an option become '_'. The result has at most 128 bytes.
std::string fileNameFrom(std::string_view text);

}  // namespace viewloom
