// SPDX-License-Identifier: Apache-2.0
// The views of each picture as engines take them. Layouts stay as long as a display, its eyes,
// its focal plane and its stream ask for nothing else; views are aimed anew when a camera moves, in
// memory that is there.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "display/atlas_layout.h"
#include "display/focus_follower.h"
#include "picture/trace_job.h"
#include "pipeline/aim.h"
#include "publish/broadcaster.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread; pictures may be let go on any.
class PictureCache {
 public:
  explicit PictureCache(AtlasLimits limits) : limits_(limits) {}

  // `eyes`: of a tracked display, as they come; nullptr = none came yet. Fails when the display
  // does not fit the stream, the eyes or the limits; errors name the field.
  absl::StatusOr<PicturePtr> get(const ActiveDisplay& display, const ResidentStructure& source,
                                 const Aim& aim, const EyePosesPtr& eyes = nullptr);
  // Forgets the pictures that none of these displays shows.
  void keepOnly(const std::vector<ActiveDisplayPtr>& displays);

 private:
  struct Entry {
    std::mutex mutex;  // guards what follows
    StreamDefaults defaults;
    uint64_t taking_count = 0;  // ResidentStructure::taking
    EyePosesPtr eyes;
    FocusFollower focus;
    std::optional<double> focal_distance_m;       // where it has moved to
    std::shared_ptr<const AtlasLayout> layout;    // of all that
    std::vector<std::shared_ptr<TraceJob>> jobs;  // the last aimed is in front
    Aim aim;                                      // of the last
  };

  std::shared_ptr<Entry> entryOf(const std::string& picture_key);
  absl::Status layOut(const ActiveDisplay& display, const StreamDefaults& defaults,
                      const EyePosesPtr& eyes, Entry& entry) const;
  static bool moveFocus(const DisplaySpec& spec, const ResidentStructure& source, Entry& entry);

  const AtlasLimits limits_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Entry>> entries_;  // by picture_key; guarded by mutex_
};

}  // namespace viewloom
