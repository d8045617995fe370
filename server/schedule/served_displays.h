// SPDX-License-Identifier: Apache-2.0
// Atlases that displays were given last, and which displays a job has something new for. EyeTrack
// knows the eyes that a display was shown for.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "publish/broadcaster.h"
#include "schedule/atlas_job.h"

namespace viewloom {

// The displays that a job is for, and by which eyes they are seen.
struct UnservedDisplays {
  std::vector<ActiveDisplayPtr> displays;
  EyePosesPtr eyes;
};

// Thread-safety: all methods may be called from any thread.
class ServedDisplays {
 public:
  explicit ServedDisplays(const Broadcaster& broadcaster) : broadcaster_(broadcaster) {}

  // The displays of the picture that have not got this structure, or a newer one; or have got it,
  // but not as the newest eyes see it, or not from where its camera is by now, or want it again.
  // A structure that they have not got comes with a job of its own.
  UnservedDisplays find(const AtlasJob& job);
  // From now on these have got what the job shows.
  void note(const AtlasJob& job, const UnservedDisplays& served);

 private:
  // Contents of the last atlas of a display.
  struct Served {
    uint64_t serial = 0;                // of its structure
    std::optional<ShownInstant> shown;  // at a tick
  };

  // Goes over all of these for each that was served: for when some have gone.
  void forgetOthers(const std::vector<ActiveDisplayPtr>& displays);

  const Broadcaster& broadcaster_;
  std::mutex mutex_;
  std::map<uint64_t, Served> served_;  // by display, as last begun; guarded by mutex_
};

}  // namespace viewloom
