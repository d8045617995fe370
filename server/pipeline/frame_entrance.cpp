// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame_entrance.h"

#include <utility>
#include <vector>

#include "base/log.h"
#include "pipeline/within_memory.h"

namespace viewloom {

bool FrameEntrance::wantsFrame(const std::string& name) {
  if (is_stopped_) return true;  // to be refused
  const PipelineStreamPtr stream = streams_.open(name);
  FrameDoor::Answer answer = stream->door.knock();
  if (answer == FrameDoor::Answer::kFirst) {
    if (takesUnasked(*stream)) {
      stream->door.open();
      answer = stream->door.knock();
    } else {
      events_.ring_builds();  // in the end it is built unasked
      queuePictures(*stream);
    }
  }
  return answer == FrameDoor::Answer::kComeIn;
}

// False where there is no memory to know it: the builders look again.
bool FrameEntrance::takesUnasked(const PipelineStream& stream) const {
  bool takes = false;
  return withinMemory([&] { takes = events_.takes_unasked(stream); }).ok() && takes;
}

void FrameEntrance::noteLost(const std::string& name) {
  const PipelineStreamPtr stream = streams_.find(name);
  if (!stream) return;
  stream->door.close();
  goOn(*stream);
}

void FrameEntrance::noteOffered(const PipelineStreamPtr& stream) {
  if (stream->door.enter()) queuePictures(*stream);
  events_.ring_builds();
}

bool FrameEntrance::askNewer(const std::string& name, const std::string& picture_key) {
  const PipelineStreamPtr stream = streams_.find(name);
  if (!stream || is_stopped_) return false;
  asked_.add(name, picture_key);  // before the door is looked at: goOn() finds all who have asked
  if (letIn(*stream)) return true;
  asked_.remove(name, picture_key);
  return false;
}

bool FrameEntrance::letIn(PipelineStream& stream) {
  const FrameDoor::Opened opened = stream.door.open();
  if (opened == FrameDoor::Opened::kNow) {
    on_wanted_(stream.name);
    if (!stream.inbox.empty()) events_.ring_builds();  // it is decoded already
  }
  return opened != FrameDoor::Opened::kNobody;
}

// The other pictures of the stream are queued already, since the frame came.
void FrameEntrance::noteBegun(const AtlasJob& job) {
  const PipelineStreamPtr stream = streams_.find(job.structure->stream);
  if (!stream || !stream->door.hasWaiting()) return;
  queuePictures(*stream, job.picture_key);
  if (job.is_tracked) events_.ring_builds();  // see StreamDemand::takes_all
}

void FrameEntrance::goOn(PipelineStream& stream) {
  if (!stream.inbox.empty() && stream.door.enter()) queuePictures(stream);  // it came meanwhile
  on_wanted_(stream.name);
  beginAsked(stream.name);
}

void FrameEntrance::forget(const std::string& stream) {
  streams_.forget(stream);
  on_wanted_(stream);
  beginAsked(stream);
}

// Where nothing is resident, the first frame needs no picture to ask for it. Without memory for the
// jobs, the frame is built unasked.
void FrameEntrance::queuePictures(const PipelineStream& stream,
                                  std::optional<std::string> picture_key) {
  const ResidentPtr resident = stream.resident();
  if (!resident) return;
  const absl::Status status = withinMemory([&] {
    std::vector<ActiveDisplayPtr> displays = broadcaster_.displays(stream.name);
    if (picture_key) {
      std::erase_if(displays, [&](const ActiveDisplayPtr& display) {
        return display->picture_key != *picture_key;
      });
    }
    for (AtlasJob& job : jobsForWaiting(resident, displays, clock_.nowNs())) {
      events_.offer(std::move(job));
    }
  });
  if (!status.ok()) log(LogLevel::kWarning, "stream ", stream.name, ": ", status.message());
}

void FrameEntrance::beginAsked(const std::string& stream) {
  const AskedPictures::Keys pictures = asked_.takeAll(stream);
  if (pictures.empty()) return;
  for (const auto& [name, picture_key] : pictures) events_.finish(picture_key);
  events_.on_finished();
}

}  // namespace viewloom
