// SPDX-License-Identifier: Apache-2.0
#include "cli/recorded_atlases.h"

#include <optional>
#include <utility>

#include "base/str_cat.h"
#include "cli/interrupt.h"
#include "cli/report_error.h"
#include "cli/status_line.h"
#include "recording/atlas_recording.h"

namespace viewloom::cli {
namespace {

constexpr int64_t kUsualStep_ns = 33'333'333;  // how long the only picture of a video is shown

struct Found {
  uint64_t atlas_count = 0;
  int64_t first_ns = 0;
  int64_t last_ns = 0;
  int64_t step_ns = kUsualStep_ns;  // from the last but one to the last

  void note(int64_t time_ns) {
    if (atlas_count++ == 0) first_ns = last_ns = time_ns;
    if (time_ns > last_ns) step_ns = time_ns - last_ns;
    last_ns = time_ns;
  }
  double span_s() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
};

std::string descriptionOf(const Found& found, const v1::AtlasLayout& layout) {
  return strCat(found.atlas_count, found.atlas_count == 1 ? " atlas" : " atlases", " in ",
                formatNumber(found.span_s(), 1), " s, ", layout.size().width(), "x",
                layout.size().height(), ", ", layout.view_count(), " views of ",
                layout.tile_size().width(), "x", layout.tile_size().height());
}

}  // namespace

int watchRecording(const RecordedWatch& options, const CommonOptions& common) {
  const auto fail = [&](const absl::Status& status, int code) {
    reportError(status, common);
    return code;
  };
  StatusLine line(true);
  const auto reader = AtlasRecordingReader::open(options.file);
  if (!reader.ok()) return fail(reader.status(), kExitUsage);
  const auto outputs = AtlasOutputs::open(options.output, line);
  if (!outputs.ok()) return fail(outputs.status(), kExitUsage);
  (*outputs)->beginInterruptible();
  Found found;
  std::string description;
  absl::Status failed;
  while (failed.ok() && !isInterrupted() &&
         (options.count == 0 || found.atlas_count < options.count)) {
    const absl::StatusOr<std::optional<RecordedAtlas>> recorded = (*reader)->next();
    if (!recorded.ok()) return fail(recorded.status(), kExitUsage);
    if (!recorded->has_value()) break;
    const RecordedAtlas& newest = **recorded;
    found.note(newest.time_ns);
    description = descriptionOf(found, *newest.atlas.layout);
    failed = (*outputs)->write(newest.atlas, newest.time_ns);
  }
  if (found.atlas_count == 0 && !isInterrupted()) {
    return fail(
        absl::InvalidArgumentError(strCat(
            options.file, ": contains no complete atlas. Record it again with `viewloom record`")),
        kExitUsage);
  }
  const absl::Status completed = (*outputs)->complete(found.last_ns + found.step_ns);
  if (!failed.ok()) return fail(failed, kExitFailed);
  if (!completed.ok()) return fail(completed, kExitFailed);
  line.say(strCat(options.file, ": ", description));
  if ((*reader)->isCutShort()) {
    line.say(strCat(options.file, ": ends before it is complete; the complete atlases were ",
                    (*outputs)->isEmpty() ? "counted" : "saved"));
  }
  return kExitDone;
}

}  // namespace viewloom::cli
