// SPDX-License-Identifier: Apache-2.0
// What a display sees of the structures of a job, and from where.
#pragma once

#include "pipeline/job_queue.h"
#include "pipeline/picture_cache.h"

namespace viewloom {

// A display without a place of its own stands where the camera is at the time shown.
Aim aimOf(const ActiveDisplay& display, const AtlasJob& job);

}  // namespace viewloom
