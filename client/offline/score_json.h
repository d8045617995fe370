// SPDX-License-Identifier: Apache-2.0
// Scores as commands print them.
#pragma once

#include <nlohmann/json.hpp>

#include "scoring/class_scores.h"

namespace viewloom {

// {"covered", "hidden", "outside", "all"}, each with "pixels", "share", "psnr_db" (a number, "inf"
// for identical pictures, null without pixels), "ssim" and "flip" (null without pixels).
nlohmann::ordered_json scoreJson(const ClassScores& scores);

}  // namespace viewloom
