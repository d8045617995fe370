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

struct Found {
  uint64_t atlas_count = 0;
  double span_s = 0;  // from the first atlas to the last
};

std::string descriptionOf(const Found& found, const v1::AtlasLayout& layout) {
  return strCat(found.atlas_count, found.atlas_count == 1 ? " atlas" : " atlases", " in ",
                formatNumber(found.span_s, 1), " s, ", layout.size().width(), "x",
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
  const InterruptLimit limit;
  AtlasFiles files(options.output);
  Found found;
  std::string description;
  std::optional<int64_t> first_ns;
  while (!isInterrupted() && (options.count == 0 || found.atlas_count < options.count)) {
    const absl::StatusOr<std::optional<RecordedAtlas>> recorded = (*reader)->next();
    if (!recorded.ok()) return fail(recorded.status(), kExitUsage);
    if (!recorded->has_value()) break;
    const RecordedAtlas& newest = **recorded;
    if (!first_ns) first_ns = newest.time_ns;
    ++found.atlas_count;
    found.span_s = static_cast<double>(newest.time_ns - *first_ns) * 1e-9;
    description = descriptionOf(found, *newest.atlas.layout);
    if (options.output.folder.empty()) continue;
    const absl::StatusOr<AtlasFiles::Written> written = files.write(newest.atlas);
    if (!written.ok()) return fail(written.status(), kExitFailed);
    line.print(describe(*written));
  }
  if (found.atlas_count == 0 && !isInterrupted()) {
    return fail(
        absl::InvalidArgumentError(strCat(
            options.file, ": contains no complete atlas. Record it again with `viewloom record`")),
        kExitUsage);
  }
  line.say(strCat(options.file, ": ", description));
  if ((*reader)->isCutShort()) {
    line.say(strCat(options.file, ": ends before it is complete; the complete atlases were ",
                    options.output.folder.empty() ? "counted" : "saved"));
  }
  return kExitDone;
}

}  // namespace viewloom::cli
