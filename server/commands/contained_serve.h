// SPDX-License-Identifier: Apache-2.0
// Rights that `viewloomd serve` keeps, from its settings.
#pragma once

#include "config/config.h"
#include "containment/containment.h"

namespace viewloom {

// A setting that names a file which the server reads, at its start or later, has its file here.
ContainmentOptions containmentOf(const Config& config);

}  // namespace viewloom
