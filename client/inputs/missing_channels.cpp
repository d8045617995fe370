// SPDX-License-Identifier: Apache-2.0
#include "inputs/missing_channels.h"

#include <string>

#include "base/str_cat.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "files/exr_usual.h"
#include "files/file_bytes.h"

namespace viewloom::inputs {
namespace {

absl::Status refuseMissing(const std::string& file, const std::string& problem,
                           const files::ExrDescription& description) {
  return files::refuseFile(file, strCat(problem, "; it has ", files::listExrChannels(description)));
}

}  // namespace

absl::Status requireExrChannels(const InputFiles& files, const Interpretation& how) {
  const v1::LayerFiles& layer = how.source.layers(0);
  if (files::isExr(files.color) && layer.color().channels().empty()) {
    const auto description = files::describeExr(files.color);
    if (!description.ok()) return description.status();
    if (!layer.depth().channels().empty() && files.depth.empty()) {
      return refuseMissing(files.color,
                           strCat("has depth alone, in ", layer.depth().channels(0),
                                  ": name the colour file first and this one with --depth, "
                                  "or its colour with --color-channels"),
                           *description);
    }
    if (files::hasPositionsAlone(*description)) {
      return refuseMissing(files.color,
                           "has positions (X, Y and Z of a point) and no colour; accepted are "
                           "colour and depth: name the colour file first and this one with --depth "
                           "and, where Z is the depth, --depth-channel Z",
                           *description);
    }
    return refuseMissing(files.color,
                         "has no colour by a usual name; name it with --color-channels LAYER or "
                         "R,G,B",
                         *description);
  }
  const std::string& depth_file = files.depth.empty() ? files.color : files.depth;
  if (!files::isExr(depth_file) || !layer.depth().channels().empty()) return absl::OkStatus();
  const auto description = files::describeExr(depth_file);
  if (!description.ok()) return description.status();
  return refuseMissing(depth_file,
                       "has no depth by a usual name; name its channel with --depth-channel, or a "
                       "file with --depth",
                       *description);
}

}  // namespace viewloom::inputs
