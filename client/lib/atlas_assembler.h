// SPDX-License-Identifier: Apache-2.0
// Puts the messages of StreamAtlases together to whole atlases; what stays incomplete is discarded.
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
  uint64_t skipped = 0;    // the server said so
  uint64_t gaps = 0;  // missing in the sequence; more than skipped = lost on a change of display
};

// Foreign bytes are bounded: an atlas holds at most bytes_max.
// Thread-safety: none; one owner.
class AtlasAssembler {
 public:
  explicit AtlasAssembler(uint64_t bytes_max = uint64_t{2} << 30);

  // A new call begins: what is half done is discarded, the sequence starts anew.
  void restart();
  // The atlas that this message ends, if it ends one. DATA_LOSS when the server breaks the order of
  // its messages.
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
