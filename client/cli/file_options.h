// SPDX-License-Identifier: Apache-2.0
// Options that name the files of frames.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/file_frames.h"

namespace viewloom::cli {

void addFileOptions(CLI::App& app, FileFeedOptions& options);

}  // namespace viewloom::cli
