// SPDX-License-Identifier: Apache-2.0
// Places of subscribers: how they are taken, changed and left.
#include <mutex>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "publish/broadcaster_state.h"

namespace viewloom {
namespace {

std::shared_ptr<DisplayCoding> codingOf(const EncodingSpec& encoding) {
  return adaptsToLines(encoding) ? std::make_shared<DisplayCoding>(encoding) : nullptr;
}

std::shared_ptr<AtlasChain> chainOf(const EncodingSpec& encoding) {
  return isChained(encoding) ? std::make_shared<AtlasChain>() : nullptr;
}

// A stream's name holds no blank, so that the parts of a picture's key cannot run into each other.
std::string keyOf(const ActiveDisplay& display) {
  return strCat(display.picture_key, encodingKey(display.encoding));
}

}  // namespace

absl::Status Broadcaster::State::checkRoom(bool opens_display, const WatcherPlace& left) const {
  if (is_draining) return absl::UnavailableError("the server is shutting down; try again later");
  return displays.checkRoom(opens_display, left);
}

uint64_t Broadcaster::State::takeId() {
  std::lock_guard lock(mutex);
  return displays.takeId();
}

// Without the lock while memory is asked for: idle memory may have to be given up for it, whose
// owner may ask this broadcaster.
absl::StatusOr<Seat> Broadcaster::State::admit(const ActiveDisplay& display, const std::string& key,
                                               const Subscriber& subscriber,
                                               const WatcherPlace& left) const {
  bool opens = false;
  {
    std::lock_guard lock(mutex);
    opens = !displays.isOpen(key);
    VIEWLOOM_RETURN_IF_ERROR(checkRoom(opens, left));
  }
  return admitSeat(memory, display.spec, display.encoding, subscriber.identity(), opens);
}

// None = the display has been closed since the seat was admitted.
absl::StatusOr<std::optional<Broadcaster::State::Joined>> Broadcaster::State::join(
    const ActiveDisplay& display, const std::string& key,
    const std::shared_ptr<Subscriber>& subscriber, Seat& seat, const WatcherPlace& left) {
  std::lock_guard lock(mutex);
  const bool is_open = displays.isOpen(key);
  if (!is_open && !seat.opens) return std::nullopt;
  VIEWLOOM_RETURN_IF_ERROR(checkRoom(!is_open, left));
  auto member = std::make_shared<Member>(displays.takeId(), subscriber, std::move(seat.viewer));
  WatchedDisplay& joined =
      is_open ? displays.at(key) : displays.open(display, key, std::move(seat.display));
  displays.add(joined, member);
  std::string left_stream;
  displays.remove(left, left_stream);
  return Joined{std::move(member), joined.active, joined.newest, joined.growing,
                std::move(left_stream)};
}

absl::StatusOr<Broadcaster::State::Joined> Broadcaster::State::take(
    const ActiveDisplay& display, const std::string& key,
    const std::shared_ptr<Subscriber>& subscriber, const WatcherPlace& left) {
  for (;;) {
    absl::StatusOr<Seat> seat = admit(display, key, *subscriber, left);
    VIEWLOOM_RETURN_IF_ERROR(seat.status());
    absl::StatusOr<std::optional<Joined>> joined = join(display, key, subscriber, *seat, left);
    VIEWLOOM_RETURN_IF_ERROR(joined.status());
    if (joined->has_value()) return **std::move(joined);
  }
}

void Broadcaster::State::tell(const Joined& joined) const {
  if (joined.newest == nullptr) announce(joined.display->stream);
  if (joined.newest != nullptr && !joined.isOutOfChain()) joined.member->offer(joined.newest);
  if (!joined.left.empty()) announce(joined.left);
  if (joined.growing != nullptr) joined.member->begin(joined.growing);
}

std::shared_ptr<DisplayCoding> Broadcaster::State::otherCoding(uint64_t display_id) {
  std::lock_guard lock(mutex);
  const WatchedDisplay* const found = displays.find(display_id);
  if (found == nullptr) return nullptr;
  ActiveDisplay other = *found->active;
  other.encoding = onOtherRung(other.encoding);
  const std::string key = keyOf(other);
  return displays.isOpen(key) ? displays.at(key).active->coding : nullptr;
}

absl::StatusOr<bool> Broadcaster::State::payForRung(const ActiveDisplay& before,
                                                    const std::string& key, int64_t now_ns) {
  const bool returns = before.encoding.rung == VideoRung::kSecond;
  {
    std::lock_guard lock(mutex);
    if (returns || displays.isOpen(key)) return false;
  }
  const std::optional<double> busy_core_count = before.coding->busyCoreCount(now_ns);
  if (busy_core_count && coding_room.take(*busy_core_count, now_ns)) return true;
  return absl::ResourceExhaustedError(
      "the server has no processor time left for a second encoding of this display");
}

absl::StatusOr<std::unique_ptr<Broadcaster::Subscription>> Broadcaster::subscribe(
    const std::string& stream, const DisplaySpec& spec, const EncodingSpec& encoding,
    const std::shared_ptr<Subscriber>& subscriber, EyeTrackPtr eyes, const WatcherPlace& replaced) {
  VIEWLOOM_CHECK(isTracked(spec) == (eyes != nullptr));
  std::string picture_key = strCat(stream, " ", displayKey(spec), arrangementKey(encoding));
  if (eyes != nullptr) picture_key += strCat("of ", state_->takeId(), " ");
  const ActiveDisplay display{.stream = stream,
                              .spec = spec,
                              .encoding = encoding,
                              .picture_key = std::move(picture_key),
                              .eyes = std::move(eyes),
                              .coding = codingOf(encoding),
                              .chain = chainOf(encoding)};
  const absl::StatusOr<State::Joined> joined =
      state_->take(display, keyOf(display), subscriber, replaced);
  VIEWLOOM_RETURN_IF_ERROR(joined.status());
  auto subscription = std::make_unique<Subscription>(state_, *joined->display, *joined->member);
  if (joined->isOutOfChain()) {
    joined->display->chain->wantAtOnce();
    state_->announce(stream);
  }
  state_->tell(*joined);
  return subscription;
}

// Atlases on their way to the viewer are lost, which it may have needed: frames may stand from now
// on. One that needs no other is no hurry: where frames stand, remakeStanding() sees to it.
absl::StatusOr<std::unique_ptr<Broadcaster::Subscription>> Broadcaster::moveToRung(
    const RungMove& move, const std::shared_ptr<Subscriber>& subscriber, int64_t now_ns) {
  const ActiveDisplayPtr before = display(move.from.display_id);
  if (!before || !before->coding) {
    return absl::FailedPreconditionError("the display that the viewer is to leave has ended");
  }
  ActiveDisplay other = *before;
  other.encoding.rung = move.to;
  other.coding = before->coding->otherRung();
  other.chain = chainOf(other.encoding);
  const std::string key = keyOf(other);
  const absl::StatusOr<bool> has_paid = state_->payForRung(*before, key, now_ns);
  VIEWLOOM_RETURN_IF_ERROR(has_paid.status());
  ReaderLine line = before->coding->lineOf(move.from.subscriber_id);
  line.rung.noteMoved(now_ns);
  const absl::StatusOr<State::Joined> joined = state_->take(other, key, subscriber, move.from);
  if (!joined.ok() && *has_paid) state_->coding_room.giveBack();
  VIEWLOOM_RETURN_IF_ERROR(joined.status());
  auto subscription =
      std::make_unique<Subscription>(state_, *joined->display, *joined->member, line);
  if (joined->isOutOfChain()) joined->display->chain->want();
  state_->tell(*joined);
  return subscription;
}

Broadcaster::Subscription::Subscription(std::shared_ptr<State> state, const ActiveDisplay& display,
                                        const Member& member, const std::optional<ReaderLine>& line)
    : state_(std::move(state)),
      place_{display.id, member.id()},
      rung_(display.encoding.rung),
      coding_(display.coding),
      chain_(display.chain) {
  if (coding_) coding_->join(member.id(), member.payer(), line);
}

LineFit Broadcaster::Subscription::fitOfFirstRung(int64_t now_ns) const {
  const LineSpeed speed = coding_->speedOf(place_.subscriber_id, now_ns);
  if (rung_ == VideoRung::kFirst) return coding_->fitOf(speed, now_ns);
  // Nothing is gained by a second encoding where nobody is on the first rung, or that is no finer.
  const std::shared_ptr<DisplayCoding> first = state_->otherCoding(place_.display_id);
  if (!first || first->qp() >= coding_->qp()) return LineFit::kFits;
  return first->fitOf(speed, now_ns);
}

std::optional<RungMove> Broadcaster::Subscription::wantedMove(int64_t now_ns) {
  if (!coding_) return std::nullopt;
  const bool wants = coding_->wantsOtherRung(place_.subscriber_id, fitOfFirstRung(now_ns), now_ns);
  const bool is_first = rung_ == VideoRung::kFirst;
  const bool has_to_go = !is_first && state_->coding_room.isOver();
  if (!wants && !has_to_go) return std::nullopt;
  return RungMove{.from = place_, .to = is_first ? VideoRung::kSecond : VideoRung::kFirst};
}

Broadcaster::Subscription::~Subscription() {
  if (coding_) coding_->leave(place_.subscriber_id);
  std::string stream;
  bool was_last = false;
  {
    std::lock_guard lock(state_->mutex);
    was_last = state_->displays.remove(place_, stream);
  }
  if (was_last) state_->announce(stream);
}

}  // namespace viewloom
