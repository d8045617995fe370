// SPDX-License-Identifier: Apache-2.0
// Every setting of viewloomd.
#pragma once

#include <vector>

#include "config/config.h"
#include "config/setting.h"

namespace viewloom {

// All settings, bound to `config`, which must outlive them. In the order of the example file.
std::vector<Setting> settingsOf(Config& config);

}  // namespace viewloom
