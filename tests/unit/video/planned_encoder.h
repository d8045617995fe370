// SPDX-License-Identifier: Apache-2.0
// Encoders of tests, which do what OpenH264 does, or what goes wrong.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "video/encoder_kind.h"
#include "video/openh264_kind.h"

namespace viewloom::test {

// Changes a call of encode(), number `call` from 0, or of setQp().
struct EncoderPlan {
  std::function<absl::Status(int call)> before = [](int) { return absl::OkStatus(); };
  std::function<absl::Status(uint32_t qp)> before_qp = [](uint32_t) { return absl::OkStatus(); };
  std::function<VideoPicture(VideoPicture)> picture = [](VideoPicture given) { return given; };
  std::function<Reference(Reference)> reference = [](Reference given) { return given; };
  std::function<void(std::vector<uint8_t>&)> after = [](std::vector<uint8_t>&) {};
};

class PlannedEncoder final : public VideoEncoder {
 public:
  PlannedEncoder(std::unique_ptr<VideoEncoder> encoder, EncoderPlan plan)
      : encoder_(std::move(encoder)), plan_(std::move(plan)) {}

  const VideoFormat& format() const override { return encoder_->format(); }
  absl::Status setQp(uint32_t qp) override {
    VIEWLOOM_RETURN_IF_ERROR(plan_.before_qp(qp));
    return encoder_->setQp(qp);
  }
  absl::Status encode(const VideoPicture& picture, Reference reference,
                      std::vector<uint8_t>& access_unit) override {
    VIEWLOOM_RETURN_IF_ERROR(plan_.before(call_++));
    VIEWLOOM_RETURN_IF_ERROR(
        encoder_->encode(plan_.picture(picture), plan_.reference(reference), access_unit));
    plan_.after(access_unit);
    return absl::OkStatus();
  }

 private:
  const std::unique_ptr<VideoEncoder> encoder_;
  const EncoderPlan plan_;
  int call_ = 0;
};

inline VideoEncoderKind plannedKind(std::string name, EncoderPlan plan) {
  const auto make =
      [plan = std::move(plan)](
          const VideoFormat& format) -> absl::StatusOr<std::unique_ptr<VideoEncoder>> {
    auto made = openH264Kind().make(format);
    VIEWLOOM_RETURN_IF_ERROR(made.status());
    return std::make_unique<PlannedEncoder>(*std::move(made), plan);
  };
  return {.name = std::move(name), .library = "library 1.0", .limit = {}, .make = make};
}

// A device that is not there.
inline VideoEncoderKind missingKind(std::string name) {
  return {.name = std::move(name),
          .library = "library 1.0",
          .limit = {},
          .make = [](const VideoFormat&) -> absl::StatusOr<std::unique_ptr<VideoEncoder>> {
            return absl::UnavailableError("there is no such device");
          }};
}

// An encoder that fails from its call `first` on.
inline EncoderPlan failingFrom(int first) {
  EncoderPlan plan;
  plan.before = [first](int call) {
    return call < first ? absl::OkStatus() : absl::InternalError("the device is lost");
  };
  return plan;
}

}  // namespace viewloom::test
