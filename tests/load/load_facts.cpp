// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "load/load_report.h"

namespace viewloom::load {
namespace {

// By how much the server may grow from the second to the last quarter of a run: what the C library
// keeps of freed memory, and buffers that met their largest frame late.
constexpr double kGrowthShareMax = 0.25;
constexpr double kGrowthBytesMax = 64e6;
// Shorter runs have no quarters worth comparing.
constexpr size_t kUsageSamplesMin = 20;

class Problems {
 public:
  // Notes a broken promise of `who`.
  void require(bool holds, const std::string& who, const std::string& what) {
    if (!holds) sentences_.push_back(who + " " + what);
  }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  std::vector<std::string> sentences_;
};

void judgePublisher(const PublisherBook& book, Problems& problems) {
  const auto require = [&](bool holds, const std::string& what) {
    problems.require(holds, "publisher of " + book.stream, what);
  };
  require(book.end.ok(), "ended with " + book.end.ToString());
  require(book.counts.reconnects == 0, "lost its connection");
  require(book.counts.sent > 0, "sent nothing");
  require(book.traced > 0, "had no frame traced");
  require(book.counts.refused == 0, "had frames refused");
  require(book.repeated_reports == 0, "got more than one report for a frame");
  const uint64_t gone = book.counts.offered - book.counts.replaced_here;
  require(book.reported_frames == gone, "sent " + std::to_string(gone) +
                                            " frames and got reports of " +
                                            std::to_string(book.reported_frames));
}

void judgeDisplay(const DisplayBook& book, Problems& problems) {
  const auto require = [&](bool holds, const std::string& what) {
    problems.require(holds, book.kind + " display of " + book.stream, what);
  };
  require(book.end.code() == absl::StatusCode::kCancelled,
          "was to be stopped and ended with " + book.end.ToString());
  require(book.counts.reconnects == 0, "lost its connection");
  require(book.counts.atlases.whole > 0, "got no atlas");
  require(book.sequences_back == 0, "got a sequence that did not grow");
  require(book.frames_back == 0, "got an older frame after a newer one");
  require(book.counts.atlases.gaps <= book.counts.atlases.skipped,
          "misses " + std::to_string(book.counts.atlases.gaps) + " atlases and was told of " +
              std::to_string(book.counts.atlases.skipped));
}

// Largest resident size in a part of the run, as shares of it.
double residentBytes(const std::vector<ProcessUsage>& usage, double from, double to) {
  const auto at = [&](double share) {
    return usage.begin() + static_cast<long>(share * static_cast<double>(usage.size()));
  };
  uint64_t most = 0;
  for (auto it = at(from); it != at(to); ++it) most = std::max(most, it->resident_bytes);
  return static_cast<double>(most);
}

void judgeServer(const LoadResult& result, Problems& problems) {
  problems.require(result.server_exit_code == 0, "the server",
                   "ended with exit code " + std::to_string(result.server_exit_code));
  if (result.server_usage.size() < kUsageSamplesMin) return;
  const double early = residentBytes(result.server_usage, 0.25, 0.5);
  const double late = residentBytes(result.server_usage, 0.75, 1);
  problems.require(late <= early * (1 + kGrowthShareMax) + kGrowthBytesMax, "the server",
                   "grew from " + std::to_string(early) + " to " + std::to_string(late) +
                       " bytes under a steady load");
}

}  // namespace

std::vector<std::string> findProblems(const LoadOptions& options, const LoadResult& result) {
  Problems problems;
  problems.require(result.publishers.size() == options.publishers, "a publisher", "is missing");
  problems.require(result.displays.size() == options.displays, "a display", "is missing");
  for (const PublisherBook& book : result.publishers) judgePublisher(book, problems);
  for (const DisplayBook& book : result.displays) judgeDisplay(book, problems);
  judgeServer(result, problems);
  return problems.take();
}

}  // namespace viewloom::load
