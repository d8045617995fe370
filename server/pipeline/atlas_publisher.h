// SPDX-License-Identifier: Apache-2.0
// Opens the atlases of runs, so that bands leave when they are packed, and completes them, each
// picture's in the order in which they began.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "pipeline/atlas_run.h"
#include "pipeline/pipeline_links.h"

namespace viewloom {

// Strips of one picture's next atlas may be packed before the last of this one: the order in which
// they become whole is kept here.
// Thread-safety: all methods may be called from any thread.
class AtlasPublisher {
 public:
  // `on_complete` is called after complete(), on its thread.
  AtlasPublisher(const PipelineLinks& links, std::function<void(const AtlasRun& run)> on_complete)
      : links_(links), on_complete_(std::move(on_complete)) {}

  // Tells the run if an older one of its picture is on its way.
  void begin(AtlasRunPtr run);
  // The run's making has begun: its displays hear of their atlases. From one thread a picture.
  void open(AtlasRun& run) const;
  // Every strip of the run is packed.
  void complete(const AtlasRun& run);
  // Memory ran out for the run: it will not be completed, and its displays end with this status.
  // Atlases behind it go on. Nothing happens to a run that is complete, or given up.
  void giveUp(AtlasRun& run, const absl::Status& status);
  // Gives up the runs whose displays nobody watches any more. `on_complete` is called for them.
  // Never waits: false where somebody hands an atlas out just now, and nothing was done.
  bool giveUpUnwatched();
  // Gives up all runs; they stay until dropAll().
  void giveUpAll();
  // Abandons the runs that will not be completed.
  void dropAll();

 private:
  struct Pending {
    AtlasRunPtr run;
    bool is_complete = false;
  };

  void publishInOrder(const AtlasRun& run);
  // With the lock.
  void publishCompleted(std::deque<Pending>& runs);
  void publish(AtlasRun& run);

  const PipelineLinks& links_;
  const std::function<void(const AtlasRun& run)> on_complete_;
  std::mutex mutex_;
  std::map<std::string, std::deque<Pending>> pending_;  // by picture, oldest first
};

}  // namespace viewloom
