// SPDX-License-Identifier: Apache-2.0
#include "frame/timing_text.h"

namespace viewloom {

const char* timingText(Timing timing) {
  switch (timing) {
    case Timing::kCaptured:
      return "captured";
    case Timing::kPredicted:
      return "predicted";
    case Timing::kInterpolated:
      return "interpolated";
    case Timing::kHeld:
      return "held";
  }
  return "";
}

}  // namespace viewloom
