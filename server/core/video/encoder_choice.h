// SPDX-License-Identifier: Apache-2.0
// The kind of video encoder that a program uses, chosen among those that it has.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "video/encoder_kind.h"
#include "video/encoder_probe.h"

namespace viewloom {

class VideoEncoderChoice;
using VideoEncoderChoicePtr = std::shared_ptr<const VideoEncoderChoice>;

// Where the chosen kind cannot make an encoder, or an encoder of it fails between two pictures,
// OpenH264 takes its place. Thread-safety: all methods may be called from any thread.
class VideoEncoderChoice {
 public:
  // The first automatic kind of a list.
  static constexpr std::string_view kAutomatic = "auto";

  // OpenH264, without a probe.
  static VideoEncoderChoicePtr openH264();

  // Takes the first of `kinds` that passes its probe, if `wanted` is kAutomatic; else the kind of
  // that name. OpenH264 is taken if no other passes. INVALID_ARGUMENT if no kind has that name.
  static absl::StatusOr<VideoEncoderChoicePtr> choose(const std::vector<VideoEncoderKind>& kinds,
                                                      std::string_view wanted);

  // Errors as OpenH264Encoder::make. Pictures beyond OpenH264's limit have no replacement.
  absl::StatusOr<std::unique_ptr<VideoEncoder>> make(const VideoFormat& format) const;

  // An encoder that nothing replaces when it fails, and its kind.
  struct Begun {
    std::unique_ptr<VideoEncoder> encoder;
    VideoEncoderKind kind;
  };
  // The same for a stream whose parameter sets have to stay.
  absl::StatusOr<Begun> begin(const VideoFormat& format) const;
  // Such an encoder of the chosen kind has failed for good: OpenH264 takes its place elsewhere.
  void noteFailure(const absl::Status& failure) const;

  const PictureLimit& limit() const { return kind_.limit; }
  // "h264_nvenc (libavcodec 59.37.100)".
  std::string text() const;
  // The kinds that were tried, in this order.
  const std::vector<EncoderProbe>& probes() const { return probes_; }

  VideoEncoderChoice(VideoEncoderKind kind, std::vector<EncoderProbe> probes);

 private:
  struct Failures;

  bool isOpenH264() const;
  static void note(Failures& failures, const std::string& name, const absl::Status& failure);

  const VideoEncoderKind kind_;
  const VideoEncoderKind openh264_;
  const std::vector<EncoderProbe> probes_;
  const std::shared_ptr<Failures> failures_;
};

}  // namespace viewloom
