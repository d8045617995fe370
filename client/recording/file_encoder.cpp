// SPDX-License-Identifier: Apache-2.0
#include "recording/file_encoder.h"

#include <vector>

#include "codecs/video_kinds.h"

namespace viewloom {

absl::StatusOr<VideoEncoderChoicePtr> chooseFileEncoder(std::string_view wanted) {
  std::vector<VideoEncoderKind> kinds = videoEncoderKinds();
  for (VideoEncoderKind& kind : kinds) kind.is_automatic = true;
  return VideoEncoderChoice::choose(kinds, wanted);
}

}  // namespace viewloom
