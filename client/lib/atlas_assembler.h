// SPDX-License-Identifier: Apache-2.0
// Assembles whole atlases from the messages of StreamAtlases. Incomplete atlases are discarded.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/status.h"
#include "lib/atlas.h"

namespace viewloom {

struct AtlasCounts {
  uint64_t whole = 0;
  uint64_t discarded = 0;  // begun, and abandoned by the server or never ended
  uint64_t skipped = 0;    // by the server, in Skipped messages
  uint64_t gaps = 0;  // missing numbers; more than skipped means that a change of display lost some
};

// An atlas holds at most bytes_max bytes, whatever the server sends.
// Thread-safety: none; one owner.
class AtlasAssembler {
 public:
  explicit AtlasAssembler(uint64_t bytes_max = uint64_t{2} << 30);

  // Begins a new call: an unfinished atlas is discarded, and the sequence starts again.
  void restart();
  // Takes a message and returns the atlas that it completes, if any. DATA_LOSS if messages of the
  // server are out of order, or if a layout does not add up: views can be cut out of all others.
  absl::StatusOr<std::optional<Atlas>> add(v1::StreamAtlasesResponse message);
  // The newest layout; null before the first.
  std::shared_ptr<const v1::AtlasLayout> layout() const { return layout_; }
  const AtlasCounts& counts() const { return counts_; }

 private:
  void begin(v1::AtlasHeader header);
  absl::Status addBand(v1::Band band);
  absl::StatusOr<std::optional<Atlas>> end(v1::AtlasEnd end);
  void discard();

  const uint64_t bytes_max_;
  std::shared_ptr<const v1::AtlasLayout> layout_;
  std::optional<Atlas> open_;
  bool band_is_open_ = false;   // the newest band waits for further pieces
  uint64_t bytes_ = 0;          // of the open atlas
  uint64_t last_sequence_ = 0;  // 0 = none since the layout
  AtlasCounts counts_;
};

}  // namespace viewloom
