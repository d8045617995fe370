// SPDX-License-Identifier: Apache-2.0
// The encoder of video files.
#pragma once

#include <string_view>

#include "video/encoder_choice.h"

namespace viewloom {

// Tries the encoders of this program, as VideoEncoderChoice::choose. A file may take its time, so
// "auto" also takes those on the CPU that write larger pictures than OpenH264, before it.
absl::StatusOr<VideoEncoderChoicePtr> chooseFileEncoder(std::string_view wanted);

}  // namespace viewloom
