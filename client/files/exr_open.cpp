// SPDX-License-Identifier: Apache-2.0
#include "files/exr_open.h"

#include <OpenEXR/ImfHeader.h>

#include <exception>
#include <mutex>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// Of a data window or a tile: far beyond any display window, yet no chunk table of gigabytes.
constexpr int kDataSideMax_px = 32768;

}  // namespace

absl::StatusOr<std::unique_ptr<Imf::MultiPartInputFile>> openExr(
    const std::filesystem::path& path) {
  static std::once_flag limits_set;
  std::call_once(limits_set, [] {
    Imf::Header::setMaxImageSize(kDataSideMax_px, kDataSideMax_px);
    Imf::Header::setMaxTileSize(kDataSideMax_px, kDataSideMax_px);
  });
  VIEWLOOM_RETURN_IF_ERROR(checkFile(path));
  try {
    return std::make_unique<Imf::MultiPartInputFile>(path.c_str());
  } catch (const std::exception& error) {
    return refuseFile(path.string(), absl::StrCat("is no EXR file to be read: ", error.what()));
  }
}

}  // namespace viewloom::files
