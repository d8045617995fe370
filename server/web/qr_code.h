// SPDX-License-Identifier: Apache-2.0
// QR codes of addresses, so that a phone opens them without typing.
#pragma once

#include <string>

namespace viewloom {

// Lines of block characters (UTF-8) for a terminal, two modules of the code in each, dark on light
// whatever the terminal's colours are. Empty when the text is too long for a code.
std::string qrCode(const std::string& text);

// The same as a picture (SVG), whose title is the text and whose description is `description`.
std::string qrPicture(const std::string& text, const std::string& description);

}  // namespace viewloom
