// SPDX-License-Identifier: Apache-2.0
// The header that tells a client under which name to save what it is sent.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// A value of Content-Disposition (RFC 6266). The plain name holds only what every file system takes
// and no path; where that is not `file_name`, the whole name stands beside it in UTF-8 (RFC 5987).
std::string contentDisposition(std::string_view file_name);

}  // namespace viewloom
