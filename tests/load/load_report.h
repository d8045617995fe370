// SPDX-License-Identifier: Apache-2.0
// Report of a load run: figures for people, and facts that must hold on any machine.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "load/load_run.h"

namespace viewloom::load {

nlohmann::json makeReport(const LoadOptions& options, const LoadResult& result);

// One sentence for each promise that was broken; none of them is about time.
std::vector<std::string> findProblems(const LoadOptions& options, const LoadResult& result);

}  // namespace viewloom::load
