// SPDX-License-Identifier: Apache-2.0
// The atlases of a subscriber, recorded as a video.
#pragma once

#include <memory>

#include "base/clock.h"
#include "lib/atlas_assembler.h"
#include "recording/atlas_target.h"
#include "recording/atlas_video.h"

namespace viewloom {

class VideoRecorder final : public AtlasTarget {
 public:
  // The clock must outlive the recorder. Errors as AtlasVideo::create.
  static absl::StatusOr<std::unique_ptr<VideoRecorder>> create(
      const std::filesystem::path& path, const std::string& title, const Clock& clock,
      VideoEncoderChoicePtr encoders = VideoEncoderChoice::openH264());

  // Also the errors of AtlasAssembler::add and AtlasVideo::add.
  absl::Status add(const v1::StreamAtlasesResponse& message) override;
  bool isWithinAtlas() const override { return is_within_atlas_; }
  absl::Status complete() override { return video_->complete(clock_.nowNs()); }
  std::string summary() const override { return video_->summary(); }

 private:
  VideoRecorder(std::unique_ptr<AtlasVideo> video, const Clock& clock);

  const std::unique_ptr<AtlasVideo> video_;
  const Clock& clock_;
  AtlasAssembler assembler_;
  bool is_within_atlas_ = false;
};

}  // namespace viewloom
