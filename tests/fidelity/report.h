// SPDX-License-Identifier: Apache-2.0
// Results of the trials, for programs and for people.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "fidelity/score_sets.h"

namespace viewloom::fidelity {

// {"name", "transfer", "border_px", "cut_px",
//  "views": [{"view", "columns", "rows",
//             "methods": {"viewloom", "splat", "sheet", "cut mesh": scores by the mask},
//             "viewloom_by_own_classes": scores}],
//  "row_flicker": {method: 1/255}, "column_flicker": the same, where there are such views}
// Scores are those of offline/score_json.h.
nlohmann::ordered_json trialJson(const Trial& trial, const TrialReport& report);

// A row per view and method.
std::string asTable(const nlohmann::ordered_json& trial);

}  // namespace viewloom::fidelity
