// SPDX-License-Identifier: Apache-2.0
// The views of a set as viewloom renders them.
#pragma once

#include <vector>

#include "fidelity/coarse_depth.h"
#include "offline/compare_views.h"
#include "support/data_sets.h"
#include "walk/offline_renderer.h"

namespace viewloom::fidelity {

// In the order of `views`. Throws std::runtime_error when the files cannot be read.
std::vector<RenderedView> renderViews(OfflineRenderer& renderer, const test::DataSet& set,
                                      const std::vector<test::TrueView>& views,
                                      ScoreTransfer transfer, const CoarseDepth* coarse = nullptr);

}  // namespace viewloom::fidelity
