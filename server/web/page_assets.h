// SPDX-License-Identifier: Apache-2.0
// The viewer page, as it was embedded when the program was built.
#pragma once

#include <span>
#include <string_view>

namespace viewloom {

struct PageAsset {
  std::string_view path;  // "/viewer.js"; the page itself is "/"
  std::string_view type;  // MIME
  std::string_view etag;  // quoted; a digest of the bytes
  std::string_view bytes;
};

std::span<const PageAsset> pageAssets();

}  // namespace viewloom
