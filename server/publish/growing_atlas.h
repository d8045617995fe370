// SPDX-License-Identifier: Apache-2.0
// An atlas whose bands come one after the other, for those who take them as they are packed.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "encode/encoded_band.h"

namespace viewloom {

// Somebody who takes bands of atlases as they come.
class AtlasReader {
 public:
  virtual ~AtlasReader() = default;
  // There is more of an atlas that this reader has awaited. Called on the thread that packed it,
  // without a lock of the atlas; must not block.
  virtual void noteGrowth() = 0;
};

// Bands [first, last) of an atlas, of which some are to leave together: bytes_min of them, or all
// that are left.
struct BandsWanted {
  size_t first = 0;
  size_t last = 0;
  size_t bytes_min = 1;
};

// All readers share its bytes. What is there of it never changes.
// Thread-safety: all methods may be called from any thread.
class GrowingAtlas {
 public:
  enum class State { kGrowing, kWhole, kAbandoned };

  // Everything of it is known but the bytes of its bands and its outcome.
  explicit GrowingAtlas(EncodedAtlas begun);
  // One that is whole.
  explicit GrowingAtlas(AtlasPtr whole);

  // Bands have bytes once take() says so; the outcome is known of a whole one.
  const EncodedAtlas& atlas() const { return *atlas_; }
  State state() const;

  // A band is packed; each once. Nothing happens to one that is abandoned.
  void put(size_t band, SharedBytes bytes);
  // Every band is packed.
  AtlasPtr complete(const AtlasOutcome& outcome);
  // It will never be whole. Nothing happens to one that is.
  void abandon();

  // How many bands may leave, from the first wanted on; 0 while they are too few.
  size_t readyCount(const BandsWanted& wanted) const;
  // The same. Where it is 0, the reader hears of it once it is not, or the atlas is abandoned.
  size_t await(const BandsWanted& wanted, const std::weak_ptr<AtlasReader>& reader);

 private:
  using Readers = std::vector<std::weak_ptr<AtlasReader>>;

  explicit GrowingAtlas(std::shared_ptr<EncodedAtlas> begun);

  size_t readyCountLocked(const BandsWanted& wanted) const;
  Readers takeServed();
  static void tell(const Readers& readers);

  const AtlasPtr atlas_;
  EncodedAtlas* const making_;  // the same, or nullptr of one that came whole
  mutable std::mutex mutex_;    // guards what follows, and what grows of the atlas
  State state_;
  std::map<std::weak_ptr<AtlasReader>, BandsWanted, std::owner_less<>> waiting_;
};

using GrowingAtlasPtr = std::shared_ptr<GrowingAtlas>;

}  // namespace viewloom
