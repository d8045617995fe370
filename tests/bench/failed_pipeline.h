// SPDX-License-Identifier: Apache-2.0
// A pipeline whose threads cannot go on ends the measurement.
#pragma once

#include <exception>

namespace viewloom::bench {

// Says why and ends the program, from any thread: PipelineLinks::on_failure.
[[noreturn]] void endOfFailedPipeline(const std::exception& error);

}  // namespace viewloom::bench
