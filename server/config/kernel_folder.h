// SPDX-License-Identifier: Apache-2.0
// Where compiled kernels stay from one start to the next.
#pragma once

#include <string>

namespace viewloom {

// The folder that the setting kernel_folder means; empty = none. For "auto" it is what the service
// manager ($CACHE_DIRECTORY) or the user's session ($XDG_CACHE_HOME, $HOME) has for that.
std::string kernelFolder(const std::string& setting);

}  // namespace viewloom
