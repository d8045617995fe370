// SPDX-License-Identifier: Apache-2.0
// Finds channels in the parts and views of an OpenEXR file.
#pragma once

#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <optional>
#include <string>

#include "files/exr_image.h"

namespace viewloom::files {

struct ExrChannel {
  int part = 0;
  std::string name;  // in that part
  Imf::PixelType type = Imf::HALF;
  bool subsampled = false;
};

// The channel a name stands for, see exr_image.h.
std::optional<ExrChannel> findExrChannel(const Imf::MultiPartInputFile& file,
                                         const std::string& name);

ExrViewChannels usualExrChannels(const Imf::MultiPartInputFile& file, const std::string& view);

// All channels of the file, for messages: "R, G, B, left.R".
std::string listExrChannels(const Imf::MultiPartInputFile& file);

}  // namespace viewloom::files
