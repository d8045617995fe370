// SPDX-License-Identifier: Apache-2.0
// Quality of one rung of a display's video, between its readers and the encoders.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "base/payer.h"
#include "display/display_spec.h"
#include "publish/line_fit.h"
#include "publish/quality_rung.h"
#include "publish/rate_allowance.h"
#include "publish/reader_link.h"
#include "publish/reader_rung.h"

namespace viewloom {

// Goes with a reader from rung to rung.
struct ReaderLine {
  ReaderLink link;
  RateAllowance allowance;
  ReaderRung rung;
};

// A rung follows the median of its clients' lines; of two, the faster one. The line of a client is
// the median of those of its readers, so that nobody counts more with more connections. A reader
// to which nothing was on its way in the last second shows nothing, and does not count. Slower
// readers skip atlases, until they are moved to the other rung. Once frames stand, the last atlas
// is coded again at the finest quality. Times are monotonic. Thread-safety: all methods may be
// called from any thread.
class DisplayCoding {
 public:
  // Expects an encoding that adapts to lines (adaptsToLines).
  explicit DisplayCoding(const EncodingSpec& encoding);
  // One that begins as `rung` is, of that range.
  DisplayCoding(const QualityRange& range, const QualityRung& rung) : range_(range), rung_(rung) {}
  // Coding of the display's other rung, which begins as this one is now.
  std::shared_ptr<DisplayCoding> otherRung() const;

  // For readers, each under a number of its own.
  void join(uint64_t reader, const Payer& client,
            const std::optional<ReaderLine>& line = std::nullopt);
  void leave(uint64_t reader);
  void beginWrite(uint64_t reader, uint64_t bytes, int64_t now_ns);
  void endWrite(uint64_t reader, int64_t now_ns);
  // All that this reader was written since the last such call was one atlas. Ends the write under
  // way.
  void endAtlas(uint64_t reader, int64_t now_ns);
  // Whether this reader may be given another atlas: it got no more than bits_per_second_max in the
  // last second, and in the time before.
  bool mayBegin(uint64_t reader, int64_t now_ns) const;

  // Knowledge of the reader's line so far.
  ReaderLine lineOf(uint64_t reader) const;
  LineSpeed speedOf(uint64_t reader, int64_t now_ns) const;
  // Quantisation of this rung now.
  uint32_t qp() const;
  // How this rung suits a line of that speed.
  LineFit fitOf(const LineSpeed& speed, int64_t now_ns) const;
  // To be called a few times a second, with how the first rung suits the reader. Whether it is to
  // move to the other rung: see ReaderRung.
  bool wantsOtherRung(uint64_t reader, LineFit first, int64_t now_ns);

  // For the encoders. An atlas begins: its quantisation.
  uint32_t beginAtlas(int64_t now_ns);
  // The same of the newest one, which is made again for a reader that has not got it. It comes no
  // coarser than before: all readers see it.
  uint32_t beginAgain(int64_t now_ns);
  // It was coded.
  void noteCoded(uint32_t qp, uint64_t bytes);
  // To code the newest atlas took so much time, of all threads that did it.
  void noteCodingTime(int64_t time_ns);
  // Cores that are busy with coding its atlases, such as 0.3; none = not known yet.
  std::optional<double> busyCoreCount(int64_t now_ns) const;

  // To be called a few times a second. True when frames have come to stand, and the newest atlas is
  // to be made again: beginAtlas() then gives the finest quantisation once, of which an atlas fits
  // into bits_per_second_max.
  bool wantsFiner(int64_t now_ns);
  // The newest atlas is to be made again, and has not begun yet.
  bool isWanted() const;

 private:
  struct Reader {
    Payer client;
    ReaderLine line;
  };

  // All that is known of a newcomer.
  ReaderLine newLine() const;
  // With the lock: the next atlas begins, at this quantisation at most.
  uint32_t begin(uint32_t qp_max, int64_t now_ns);
  // Value of a reader, by the median of its client, and of all clients; of two, the larger one.
  // `value_of`: of one reader; none = it does not count. None where nobody does.
  template <typename ValueOf>
  std::optional<double> median(const ValueOf& value_of) const;
  std::optional<double> medianSpeed(int64_t now_ns) const;
  // Half of the clients, or more, have all that they were written.
  bool isIdle() const;

  const QualityRange range_;
  mutable std::mutex mutex_;  // guards what follows
  QualityRung rung_;
  std::map<uint64_t, Reader> readers_;
  int64_t coding_ns_ = 0;  // of an atlas, as last noted; 0 = none yet
  bool is_wanted_ = false;
  uint32_t last_qp_ = 0;  // of the newest atlas; 0 = none yet
  int64_t begun_ns_ = 0;  // likewise
  int64_t apart_ns_ = 0;  // it and the one before; 0 = there is none
};

}  // namespace viewloom
