// SPDX-License-Identifier: Apache-2.0
#include "bench/failed_pipeline.h"

#include <cstdlib>

#include "base/log.h"

namespace viewloom::bench {

void endOfFailedPipeline(const std::exception& error) {
  log(LogLevel::kError, error.what());
  std::quick_exit(1);
}

}  // namespace viewloom::bench
