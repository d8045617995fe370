// SPDX-License-Identifier: Apache-2.0
// The views of each picture as the tracer takes them, as long as neither display nor camera moves.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "display/atlas_layout.h"
#include "publish/broadcaster.h"
#include "trace/trace_job.h"

namespace viewloom {

using PicturePtr = std::shared_ptr<const TraceJob>;

// Thread-safety: none; the GPU loop's.
class PictureCache {
 public:
  explicit PictureCache(AtlasLimits limits) : limits_(limits) {}

  // Fails when the display does not fit the stream or the limits; errors name the field.
  absl::StatusOr<PicturePtr> get(const ActiveDisplay& display, const StreamDefaults& defaults);
  // Forgets the pictures that none of these displays shows.
  void keepOnly(const std::vector<ActiveDisplayPtr>& displays);

 private:
  struct Entry {
    StreamDefaults defaults;
    PicturePtr picture;
  };

  const AtlasLimits limits_;
  std::map<std::string, Entry> entries_;  // by picture_key
};

}  // namespace viewloom
