// SPDX-License-Identifier: Apache-2.0
// Which engine makes which picture, and how: planned once, for as long as the same picture is made
// of frames that are alike.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/engines.h"
#include "publish/broadcaster.h"
#include "schedule/atlas_job.h"

namespace viewloom {

// The first engine that can make a picture, and its plan.
struct PlannedPicture {
  size_t engine = 0;  // rank in Engines::all
  PlanPtr plan;
};

// Thread-safety: all methods may be called from any thread.
class PlanCache {
 public:
  explicit PlanCache(const Engines& engines) : engines_(engines) {}

  // Plans the job's picture, as it is aimed for the job. nullopt: no engine can make it.
  std::optional<PlannedPicture> get(const AtlasJob& job, const PicturePtr& picture);
  // Forgets the plans of pictures that none of these displays shows.
  void keepOnly(const std::vector<ActiveDisplayPtr>& displays);

 private:
  struct Entry {
    PicturePtr picture;
    PlannedPicture planned;
  };

  std::optional<PlannedPicture> planAnew(const AtlasJob& job, const PicturePtr& picture,
                                         const Entry& last) const;

  const Engines& engines_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;  // by picture_key; guarded by mutex_
};

}  // namespace viewloom
