// SPDX-License-Identifier: Apache-2.0
// Says to an engine which atlas it is to make, and for whom.
#pragma once

#include <cstddef>
#include <string>

#include "engine/engine.h"
#include "pipeline/atlas_run.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// One name for all of them, by which engines know borrowers.
std::string nameOf(const Payers& payers);

// The order for a run, with the forms of its frames for this engine (rank in Engines::all). Those
// must have been taken.
AtlasOrder orderOf(const AtlasRun& run, size_t engine);

}  // namespace viewloom
