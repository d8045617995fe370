// SPDX-License-Identifier: Apache-2.0
// Options that mend what looks wrong: each is tried on the data before it is named.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "files/frame_manifest.h"
#include "inspect/inspection.h"

namespace viewloom::inspect {

// The files of a frame, which can be read again.
class Rereading {
 public:
  virtual ~Rereading() = default;
  // Reads the files with these options after the given ones, in the way of a command line. Nothing
  // if the files cannot be read so.
  virtual std::optional<files::LoadedFrame> read(const std::string& options) const = 0;
  // Text for the options: the options themselves, or entries of a manifest.
  virtual std::string spoken(const std::string& options) const = 0;
  // Nothing more is read once it is requested.
  virtual std::stop_token stop() const { return {}; }
};

struct LayerPlace {
  size_t source = 0;
  size_t layer = 0;
};

// "try --depth-scale -1 (if depth counts along -z): surfaces then lie at 1.2 .. 4 m"; "" when
// nothing that was tried takes the suspicion away without raising another.
std::string remedyFor(const Suspicion& suspicion, const LayerInspection& layer,
                      const LayerPlace& place, const Rereading& rereading);

}  // namespace viewloom::inspect
