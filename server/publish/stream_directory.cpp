// SPDX-License-Identifier: Apache-2.0
#include "publish/stream_directory.h"

#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "base/retry_delay.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr int64_t kRateWindow_ns = 2'000'000'000;
// Enough for 120 frames a second over the window; of a faster stream the newest are averaged.
constexpr size_t kRateSamplesMax = 256;
// After which it is worth asking for a name again that another publisher has.
constexpr int64_t kRetryDelay_ns = 1'000'000'000;

// When frames came in lately. Bounded.
class ArrivalTimes {
 public:
  void note(int64_t now_ns) {
    times_ns_.push_back(now_ns);
    if (times_ns_.size() > kRateSamplesMax) times_ns_.pop_front();
  }

  // Mean rate of the frames inside the window; 0 with fewer than two.
  double rateHz(int64_t now_ns) {
    while (!times_ns_.empty() && times_ns_.front() < now_ns - kRateWindow_ns) times_ns_.pop_front();
    if (times_ns_.size() < 2 || times_ns_.back() == times_ns_.front()) return 0;
    const auto span_ns = static_cast<double>(times_ns_.back() - times_ns_.front());
    return static_cast<double>(times_ns_.size() - 1) * 1e9 / span_ns;
  }

 private:
  std::deque<int64_t> times_ns_;
};

struct KnownStream {
  StreamEntry entry;
  uint64_t claim_id = 0;  // 0 = not live
  std::string session_id;
  uint64_t session = 0;  // of the last claim
  std::string host;      // likewise
  int64_t claimed_ns = 0;
  std::function<void()> on_takeover;
  int64_t released_ns = 0;
  ArrivalTimes arrivals;
};

// The count of the entry in which a frame of that outcome belongs.
uint64_t& countOf(FrameOutcome outcome, StreamEntry& entry) {
  switch (outcome) {
    case FrameOutcome::kReplaced:
      return entry.replaced_count;
    case FrameOutcome::kRefused:
      return entry.refused_count;
    case FrameOutcome::kTraced:
    case FrameOutcome::kBuiltWithoutDisplay:
    case FrameOutcome::kUnchanged:
      break;
  }
  return entry.used_count;
}

}  // namespace

struct StreamDirectory::State {
  State(const Clock& given, uint32_t count_max) : clock(given), stream_count_max(count_max) {}

  const Clock& clock;
  const uint32_t stream_count_max;

  mutable std::mutex mutex;  // guards what follows; never held while a callback runs
  std::map<std::string, KnownStream> streams;
  uint64_t next_claim_id = 1;
  std::function<bool(const std::string&)> may_forget;

  template <typename Change>
  void change(const std::string& stream, Change apply) {
    std::lock_guard lock(mutex);
    if (const auto found = streams.find(stream); found != streams.end()) apply(found->second);
  }

  absl::Status makeRoomFor(const std::string& stream);
  bool forgetOldest(int64_t unused_for_ns);
  std::vector<std::string> notLiveOldestFirst(int64_t released_until_ns) const;
};

// Says which client has the stream and since when; worth another try for the same user.
absl::Status alreadyPublished(const KnownStream& known, const std::string& host, int64_t now_ns) {
  const int64_t held_s = (now_ns - known.claimed_ns) / 1'000'000'000;
  const std::string held = held_s < 120 ? strCat(held_s, " s") : strCat(held_s / 60, " min");
  const absl::Status status = absl::AlreadyExistsError(
      strCat("stream \"", known.entry.name, "\" has a publisher",
             known.host.empty() ? "" : strCat(" on ", known.host), ", for ", held,
             " now; take another name, or its session_id to take the stream over"));
  return !host.empty() && known.host == host ? worthRetry(status, kRetryDelay_ns) : status;
}

std::vector<std::string> StreamDirectory::State::notLiveOldestFirst(
    int64_t released_until_ns) const {
  std::multimap<int64_t, std::string> by_release_ns;
  for (const auto& [name, known] : streams) {
    if (known.claim_id != 0 || known.released_ns > released_until_ns) continue;
    by_release_ns.emplace(known.released_ns, name);
  }
  std::vector<std::string> names;
  for (const auto& [released_ns, name] : by_release_ns) names.push_back(name);
  return names;
}

// Called without the lock.
bool StreamDirectory::State::forgetOldest(int64_t unused_for_ns) {
  const int64_t released_until_ns = clock.nowNs() - unused_for_ns;
  std::vector<std::string> candidates;
  std::function<bool(const std::string&)> ask;
  {
    std::lock_guard lock(mutex);
    candidates = notLiveOldestFirst(released_until_ns);
    ask = may_forget;
  }
  for (const std::string& candidate : candidates) {
    if (!ask || !ask(candidate)) continue;
    std::lock_guard lock(mutex);
    const auto found = streams.find(candidate);
    if (found == streams.end() || found->second.claim_id != 0) continue;  // claimed since
    streams.erase(found);
    return true;
  }
  return false;
}

// Called without the lock.
absl::Status StreamDirectory::State::makeRoomFor(const std::string& stream) {
  {
    std::lock_guard lock(mutex);
    if (streams.contains(stream) || streams.size() < stream_count_max) return absl::OkStatus();
  }
  if (forgetOldest(0)) return absl::OkStatus();
  return absl::ResourceExhaustedError(strCat("too many streams: this server accepts up to ",
                                             stream_count_max,
                                             "; end one, or raise limits.streams_max"));
}

StreamDirectory::StreamDirectory(const Clock& clock, uint32_t stream_count_max)
    : state_(std::make_shared<State>(clock, stream_count_max)) {}

StreamDirectory::~StreamDirectory() = default;

absl::StatusOr<std::unique_ptr<StreamDirectory::Claim>> StreamDirectory::claim(
    const std::string& stream, const std::string& session_id, std::function<void()> on_takeover,
    const std::string& host) {
  VIEWLOOM_RETURN_IF_ERROR(state_->makeRoomFor(stream));
  std::function<void()> on_old_takeover;
  uint64_t claim_id = 0;
  uint64_t session = 0;
  const int64_t now_ns = state_->clock.nowNs();
  {
    std::lock_guard lock(state_->mutex);
    const bool is_new = !state_->streams.contains(stream);
    if (is_new && state_->streams.size() >= state_->stream_count_max) {
      return absl::ResourceExhaustedError(strCat("too many streams: this server accepts up to ",
                                                 state_->stream_count_max,
                                                 "; end one, or raise limits.streams_max"));
    }
    KnownStream& known = state_->streams[stream];
    const bool is_live = known.claim_id != 0;
    if (is_live && (session_id.empty() || session_id != known.session_id)) {
      return alreadyPublished(known, host, now_ns);
    }
    if (is_live) on_old_takeover = std::move(known.on_takeover);
    claim_id = state_->next_claim_id++;
    known.entry.name = stream;
    known.entry.live = true;
    known.claim_id = claim_id;
    if (session_id.empty() || session_id != known.session_id) known.session = claim_id;
    session = known.session;
    known.session_id = session_id;
    known.host = host;
    known.claimed_ns = now_ns;
    known.on_takeover = std::move(on_takeover);
  }
  auto claim = std::make_unique<Claim>(state_, stream, claim_id, session);
  if (on_old_takeover) on_old_takeover();
  return claim;
}

bool StreamDirectory::exists(const std::string& stream) const {
  std::lock_guard lock(state_->mutex);
  return state_->streams.contains(stream);
}

double StreamDirectory::rateHz(const std::string& stream) const {
  const int64_t now_ns = state_->clock.nowNs();
  std::lock_guard lock(state_->mutex);
  const auto found = state_->streams.find(stream);
  return found == state_->streams.end() ? 0 : found->second.arrivals.rateHz(now_ns);
}

std::vector<StreamEntry> StreamDirectory::list() const {
  const int64_t now_ns = state_->clock.nowNs();
  std::lock_guard lock(state_->mutex);
  std::vector<StreamEntry> entries;
  for (auto& [name, known] : state_->streams) {
    entries.push_back(known.entry);
    entries.back().rate_hz = known.arrivals.rateHz(now_ns);
  }
  return entries;
}

void StreamDirectory::onRoomNeeded(std::function<bool(const std::string& stream)> may_forget) {
  std::lock_guard lock(state_->mutex);
  state_->may_forget = std::move(may_forget);
}

bool StreamDirectory::forgetOldest(int64_t unused_for_ns) {
  return state_->forgetOldest(unused_for_ns);
}

void StreamDirectory::countReceived(const std::string& stream) {
  const int64_t now_ns = state_->clock.nowNs();
  state_->change(stream, [now_ns](KnownStream& known) {
    ++known.entry.received_count;
    known.arrivals.note(now_ns);
  });
}

void StreamDirectory::countReported(const std::string& stream, FrameOutcome outcome) {
  state_->change(stream, [outcome](KnownStream& known) { ++countOf(outcome, known.entry); });
}

void StreamDirectory::noteResident(const std::string& stream, uint64_t frame_number, SizePx size_px,
                                   uint32_t layer_count, const SourceStats& stats) {
  state_->change(stream, [&](KnownStream& known) {
    known.entry.frame_number = frame_number;
    known.entry.size_px = size_px;
    known.entry.layer_count = layer_count;
    known.entry.stats = stats;
  });
}

StreamDirectory::Claim::Claim(std::shared_ptr<State> state, std::string stream, uint64_t claim_id,
                              uint64_t session)
    : state_(std::move(state)),
      stream_(std::move(stream)),
      claim_id_(claim_id),
      session_(session) {}

StreamDirectory::Claim::~Claim() {
  std::function<void()> on_takeover;  // destroyed after the lock
  const int64_t now_ns = state_->clock.nowNs();
  state_->change(stream_, [&](KnownStream& known) {
    if (known.claim_id != claim_id_) return;  // taken over
    known.claim_id = 0;
    known.entry.live = false;
    known.released_ns = now_ns;
    on_takeover = std::move(known.on_takeover);
  });
}

}  // namespace viewloom
