// SPDX-License-Identifier: Apache-2.0
// The video encoder of a service.
#pragma once

#include <string>

#include "video/encoder_choice.h"

namespace viewloom {

// Tries the encoders of this program, and logs which is taken. `wanted` is the setting
// pipeline.video_encoder. Throws std::runtime_error, with the remedy, for a name that none has.
VideoEncoderChoicePtr chooseVideoEncoder(const std::string& wanted);

}  // namespace viewloom
