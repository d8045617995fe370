// SPDX-License-Identifier: Apache-2.0
// The files of a frame read again, with further options, to see whether these help.
#pragma once

#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cli/frame_loader.h"
#include "inspect/remedies.h"

namespace viewloom::cli {

class OptionTrial final : public inspect::Rereading {
 public:
  OptionTrial(FrameFiles files, const LoaderOptions& options, std::stop_token stop = {})
      : files_(std::move(files)), options_(options), stop_(std::move(stop)) {}

  std::optional<files::LoadedFrame> read(const std::string& options) const override;
  std::string spoken(const std::string& options) const override;
  std::stop_token stop() const override { return stop_; }

 private:
  std::optional<files::LoadedFrame> readManifest(const inputs::InputSettings& settings) const;

  FrameFiles files_;
  LoaderOptions options_;
  std::stop_token stop_;
};

// Fills in the remedies of all suspicions.
void tryRemedies(const OptionTrial& trial, std::vector<inspect::SourceInspection>& sources);

}  // namespace viewloom::cli
