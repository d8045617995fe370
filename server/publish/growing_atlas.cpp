// SPDX-License-Identifier: Apache-2.0
#include "publish/growing_atlas.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace viewloom {

GrowingAtlas::GrowingAtlas(EncodedAtlas begun)
    : GrowingAtlas(std::make_shared<EncodedAtlas>(std::move(begun))) {}

GrowingAtlas::GrowingAtlas(std::shared_ptr<EncodedAtlas> begun)
    : atlas_(begun), making_(begun.get()), state_(State::kGrowing) {}

GrowingAtlas::GrowingAtlas(AtlasPtr whole)
    : atlas_(std::move(whole)), making_(nullptr), state_(State::kWhole) {}

GrowingAtlas::State GrowingAtlas::state() const {
  std::lock_guard lock(mutex_);
  return state_;
}

void GrowingAtlas::put(size_t band, SharedBytes bytes) {
  Readers served;
  {
    std::lock_guard lock(mutex_);
    if (state_ == State::kAbandoned) return;
    VIEWLOOM_CHECK(state_ == State::kGrowing && making_->bands[band].bytes == nullptr);
    making_->bands[band].bytes = std::move(bytes);
    served = takeServed();
  }
  tell(served);
}

AtlasPtr GrowingAtlas::complete(const AtlasOutcome& outcome) {
  Readers served;
  {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(state_ == State::kGrowing);
    VIEWLOOM_CHECK(std::ranges::none_of(
        making_->bands, [](const EncodedBand& band) { return band.bytes == nullptr; }));
    static_cast<AtlasOutcome&>(*making_) = outcome;
    state_ = State::kWhole;
    served = takeServed();
  }
  tell(served);
  return atlas_;
}

void GrowingAtlas::abandon() {
  Readers served;
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kGrowing) return;
    state_ = State::kAbandoned;
    served = takeServed();
  }
  tell(served);
}

size_t GrowingAtlas::readyCount(const BandsWanted& wanted) const {
  std::lock_guard lock(mutex_);
  return readyCountLocked(wanted);
}

size_t GrowingAtlas::await(const BandsWanted& wanted, const std::weak_ptr<AtlasReader>& reader) {
  std::lock_guard lock(mutex_);
  const size_t count = readyCountLocked(wanted);
  if (count == 0 && state_ == State::kGrowing) waiting_.insert_or_assign(reader, wanted);
  return count;
}

size_t GrowingAtlas::readyCountLocked(const BandsWanted& wanted) const {
  size_t byte_count = 0;
  size_t band = wanted.first;
  while (band < wanted.last && atlas_->bands[band].bytes != nullptr) {
    byte_count += atlas_->bands[band++].bytes->size();
  }
  const bool is_enough = band == wanted.last || byte_count >= wanted.bytes_min;
  return is_enough ? band - wanted.first : 0;
}

GrowingAtlas::Readers GrowingAtlas::takeServed() {
  Readers served;
  std::erase_if(waiting_, [&](const auto& waiting) {
    const auto& [reader, wanted] = waiting;
    if (state_ == State::kGrowing && readyCountLocked(wanted) == 0) return false;
    served.push_back(reader);
    return true;
  });
  return served;
}

void GrowingAtlas::tell(const Readers& readers) {
  for (const std::weak_ptr<AtlasReader>& reader : readers) {
    if (const auto told = reader.lock()) told->noteGrowth();
  }
}

}  // namespace viewloom
