// SPDX-License-Identifier: Apache-2.0
// Opens OpenEXR files, with limits on what their headers may ask for.
#pragma once

#include <OpenEXR/ImfMultiPartInputFile.h>

#include <filesystem>
#include <memory>

#include "base/status.h"

namespace viewloom::files {

// Headers that ask for more than the limits, attributes of more bytes than the file has among them,
// are refused before memory is spent on what they ask for.
absl::StatusOr<std::unique_ptr<Imf::MultiPartInputFile>> openExr(const std::filesystem::path& path);

}  // namespace viewloom::files
