// SPDX-License-Identifier: Apache-2.0
// Finds channels in the parts and views of an OpenEXR file.
#pragma once

#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <optional>
#include <string>

namespace viewloom::files {

struct ExrChannel {
  int part = 0;
  std::string name;  // in that part
  Imf::PixelType type = Imf::HALF;
  int x_sampling = 1;
  int y_sampling = 1;

  bool isSubsampled() const { return x_sampling != 1 || y_sampling != 1; }
};

// The channel a name stands for, see exr_image.h.
std::optional<ExrChannel> findExrChannel(const Imf::MultiPartInputFile& file,
                                         const std::string& name);

}  // namespace viewloom::files
