// SPDX-License-Identifier: Apache-2.0
#include "config/kernel_folder.h"

#include <cstdlib>

#include "base/str_cat.h"

namespace viewloom {

std::string kernelFolder(const std::string& setting) {
  if (setting != "auto") return setting;
  if (const char* folder = std::getenv("CACHE_DIRECTORY")) return folder;
  if (const char* folder = std::getenv("XDG_CACHE_HOME")) return strCat(folder, "/viewloom");
  if (const char* folder = std::getenv("HOME")) return strCat(folder, "/.cache/viewloom");
  return "";
}

}  // namespace viewloom
