// SPDX-License-Identifier: Apache-2.0
// Views that look past their source, in words.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::cli {

// "views 0-6 by 4 %, view 47 by 1 %": shares rounded up; "" where there are none.
std::string outsideText(const google::protobuf::RepeatedPtrField<v1::ViewsOutside>& views);

// Warns of displays whose views leave the source: at first, and whenever a wider field of view is
// wanted than ever before. Displays that follow an eye come and go many times a second.
// Thread-safety: all methods may be called from any thread.
class OutsideWarnings {
 public:
  // The lines to say.
  std::vector<std::string> note(const v1::Wanted& wanted);

 private:
  std::mutex mutex_;
  int told_width_deg_ = 0;
  int told_height_deg_ = 0;
};

}  // namespace viewloom::cli
