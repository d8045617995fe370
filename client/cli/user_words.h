// SPDX-License-Identifier: Apache-2.0
// A server's messages in the words of the command line.
#pragma once

#include <string>

namespace viewloom::cli {

// The message with the field that it begins with named as the user knows it: "--cone: got 400; ..."
// for "display.quilt.view_cone_rad: got 400; ...", "layer 2, depth: ..." for
// "sources[0].layers[1].depth: ...". Other messages stay.
std::string inUserWords(const std::string& message);

}  // namespace viewloom::cli
