// SPDX-License-Identifier: Apache-2.0
// Frames in, atlases out: the structure loop and the loops of the engines with everything between
// them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "display/atlas_layout.h"
#include "pipeline/decode_turns.h"
#include "pipeline/pipeline_links.h"
#include "publish/atlas_maker.h"
#include "video/encoder_choice.h"

namespace viewloom {

struct PipelineOptions {
  uint32_t encode_thread_count = 2;
  uint32_t video_thread_count = 1;  // that code one picture of a video together
  VideoEncoderChoicePtr video_encoders = VideoEncoderChoice::openH264();
  uint32_t structure_slots_per_stream = 2;  // >= 2: one is traced while the next is built
  AtlasLimits atlas_limits;
};

// Memory is bounded by streams x structure_slots_per_stream and by what engines have on their way;
// frames of the same shape and displays of the same size reuse it. What preparing frames alone
// needs is shared by the slots of a stream.
// Thread-safety: all methods may be called from any thread.
class Pipeline final : public AtlasMaker {
 public:
  Pipeline(PipelineLinks links, const PipelineOptions& options);
  // Drains.
  ~Pipeline() override;

  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override;
  bool wantsFrame(const std::string& stream) override;
  size_t nextToDecode(const std::vector<FrameOrigin>& waiting) override {
    return turnToDecode(shares(), waiting);
  }
  void noteDecoded(const FrameOrigin& origin, int64_t cpu_ns) override {
    payForDecoding(shares(), origin, cpu_ns);
  }
  void onWanted(std::function<void(const std::string&)> then) override;
  void noteLost(const std::string& stream) override;
  void forgetStream(const std::string& stream) override;
  // See Engines::preparedBytes.
  uint64_t preparedBytes(const FrameFormat& format) const;
  // Shares of the engines' time, while the pipeline lives.
  FairShares& shares();

  void serveDisplays(const std::string& stream) override;

  // The eyes before a tracked display have moved: it is served from what is resident, once its last
  // atlas is done. However often, no more than one job waits. One that ticks is served when it
  // does.
  void serveEyes(uint64_t display_id) override;

  void drain() override;

 private:
  struct Loops;
  std::unique_ptr<Loops> loops_;
};

}  // namespace viewloom
