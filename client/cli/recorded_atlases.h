// SPDX-License-Identifier: Apache-2.0
// A recording of atlases, watched: its atlases as files, and what it holds in a line.
#pragma once

#include <cstdint>
#include <string>

#include "cli/atlas_outputs.h"
#include "cli/command.h"

namespace viewloom::cli {

struct RecordedWatch {
  std::string file;
  uint32_t count = 0;  // of atlases, from the first; 0 = all
  AtlasOutputOptions output;
};

// The exit code.
int watchRecording(const RecordedWatch& options, const CommonOptions& common);

}  // namespace viewloom::cli
