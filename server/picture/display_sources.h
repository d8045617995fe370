// SPDX-License-Identifier: Apache-2.0
// Which sources a display may be shown of.
#pragma once

#include <span>

#include "base/status.h"
#include "display/display_spec.h"
#include "picture/trace_job.h"

namespace viewloom {

// Refuses what needs a single structure: the surface behind the first one, and mirrors where colour
// is seen through. FAILED_PRECONDITION if a display asks for it.
absl::Status validateSourcesOf(const DisplaySpec& spec, std::span<const SeenSource> sources);
// Whether a display may be shown of so many sources in place of fewer, those of the frame before.
bool canMerge(const DisplaySpec& spec, size_t source_count);

}  // namespace viewloom
