// SPDX-License-Identifier: Apache-2.0
#include "video/encoder_choice.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "absl/strings/str_join.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "video/fallback_encoder.h"
#include "video/openh264_kind.h"

namespace viewloom {
namespace {

void joinName(std::string* out, const VideoEncoderKind& kind) {
  out->append(kind.name);
}

PictureLimit provenLimit(const VideoEncoderKind& kind) {
  if (kind.tried_px == SizePx{} || kind.make({.size_px = kind.tried_px}).ok()) return kind.limit;
  return {};
}

}  // namespace

// Shared with encoders, which may outlive the choice.
struct VideoEncoderChoice::Failures {
  std::atomic<bool> has_failed = false;     // an encoder failed between two pictures
  std::atomic<bool> has_not_begun = false;  // one could not be made, and that was told
};

VideoEncoderChoice::VideoEncoderChoice(VideoEncoderKind kind, std::vector<EncoderProbe> probes)
    : kind_(std::move(kind)),
      openh264_(openH264Kind()),
      probes_(std::move(probes)),
      failures_(std::make_shared<Failures>()) {}

VideoEncoderChoicePtr VideoEncoderChoice::openH264() {
  static const VideoEncoderChoicePtr choice =
      std::make_shared<const VideoEncoderChoice>(openH264Kind(), std::vector<EncoderProbe>());
  return choice;
}

absl::StatusOr<VideoEncoderChoicePtr> VideoEncoderChoice::choose(
    const std::vector<VideoEncoderKind>& kinds, std::string_view wanted) {
  const bool is_automatic = wanted == kAutomatic;
  if (!is_automatic && std::ranges::find(kinds, wanted, &VideoEncoderKind::name) == kinds.end()) {
    return absl::InvalidArgumentError(strCat("\"", wanted, "\": this program has no such encoder; ",
                                             "accepted is ", kAutomatic, ", ",
                                             absl::StrJoin(kinds, ", ", joinName)));
  }
  std::vector<EncoderProbe> probes;
  for (const VideoEncoderKind& kind : kinds) {
    if (is_automatic ? !kind.is_automatic : kind.name != wanted) continue;
    probes.push_back(probeVideoEncoder(kind));
    if (probes.back().status.ok()) {
      VideoEncoderKind taken = kind;
      taken.limit = provenLimit(kind);
      return std::make_shared<const VideoEncoderChoice>(std::move(taken), std::move(probes));
    }
  }
  return std::make_shared<const VideoEncoderChoice>(openH264Kind(), std::move(probes));
}

bool VideoEncoderChoice::isOpenH264() const {
  return kind_.name == kOpenH264Name;
}

absl::StatusOr<VideoEncoderChoice::Begun> VideoEncoderChoice::begin(
    const VideoFormat& format) const {
  const auto begun = [&](const VideoEncoderKind& kind) -> absl::StatusOr<Begun> {
    auto encoder = kind.make(format);
    VIEWLOOM_RETURN_IF_ERROR(encoder.status());
    return Begun{.encoder = *std::move(encoder), .kind = kind};
  };
  if (isOpenH264() || failures_->has_failed) return begun(openh264_);
  absl::StatusOr<Begun> first = begun(kind_);
  if (first.ok() || absl::IsInvalidArgument(first.status())) return first;
  if (!failures_->has_not_begun.exchange(true)) {
    log(LogLevel::kWarning, "video: ", kind_.name, " cannot encode ", format.size_px.width, "x",
        format.size_px.height, " px: ", first.status().message(), "; OpenH264 does it instead");
  }
  return begun(openh264_);
}

absl::StatusOr<std::unique_ptr<VideoEncoder>> VideoEncoderChoice::make(
    const VideoFormat& format) const {
  absl::StatusOr<Begun> begun = begin(format);
  VIEWLOOM_RETURN_IF_ERROR(begun.status());
  if (begun->kind.name == kOpenH264Name) return std::move(begun->encoder);
  const auto on_failure = [failures = failures_, name = kind_.name](const absl::Status& failure) {
    note(*failures, name, failure);
  };
  return std::make_unique<FallbackEncoder>(std::move(begun->encoder), openh264_.make, on_failure);
}

void VideoEncoderChoice::note(Failures& failures, const std::string& name,
                              const absl::Status& failure) {
  if (failures.has_failed.exchange(true)) return;
  log(LogLevel::kWarning, "video: ", name, " has failed: ", failure.message(),
      "; OpenH264 encodes from now on, until the program is started again");
}

void VideoEncoderChoice::noteFailure(const absl::Status& failure) const {
  if (!isOpenH264()) note(*failures_, kind_.name, failure);
}

std::string VideoEncoderChoice::text() const {
  return strCat(kind_.name, " (", kind_.library, ")");
}

}  // namespace viewloom
