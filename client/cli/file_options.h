// SPDX-License-Identifier: Apache-2.0
// Options that name the files of frames.
#pragma once

#include "cli/file_frames.h"
#include "usage/command_line.h"

namespace viewloom::cli {

void addFileOptions(const usage::Command& app, FileFeedOptions& options);

}  // namespace viewloom::cli
