// SPDX-License-Identifier: Apache-2.0
// QR codes for terminals, so that a phone opens a page without typing.
#pragma once

#include <string>

namespace viewloom {

// Lines of block characters (UTF-8), two modules of the code in each, dark on light whatever the
// terminal's colours are. Empty when the text is too long for a code.
std::string qrCode(const std::string& text);

}  // namespace viewloom
