// SPDX-License-Identifier: Apache-2.0
// H.264 encoders of libavcodec.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "video/video_encoder.h"

struct AVBufferRef;
struct AVCodecContext;
struct AVDictionary;
struct AVFrame;
struct AVPacket;

namespace viewloom {

// Main profile with CABAC, at a fixed quantisation, in the form of OpenH264Encoder
// (uniform_units.h). Each picture comes at once, or the encoder has failed.
class AvcodecEncoder final : public VideoEncoder {
 public:
  // Options of an encoder, by the names that libavcodec gives them.
  struct Option {
    std::string name;
    std::string value;
  };
  // Differences from encoder to encoder.
  struct Form {
    std::string name;             // "h264_nvenc"
    PictureLimit limit;           // largest pictures
    bool has_vaapi = false;       // takes pictures of a VAAPI device
    bool takes_slices = false;    // format.thread_count threads code a slice each
    std::vector<Option> options;  // beside the quantisation, which is the option "qp"
  };

  // "libavcodec 59.37.100".
  static std::string library();

  // INVALID_ARGUMENT for a format out of range, UNAVAILABLE if this machine has no such encoder, or
  // not for such pictures.
  static absl::StatusOr<std::unique_ptr<VideoEncoder>> make(const Form& form,
                                                            const VideoFormat& format);
  ~AvcodecEncoder() override;

  const VideoFormat& format() const override { return format_; }
  // The next picture opens the encoder of libavcodec anew: most have no other way.
  absl::Status setQp(uint32_t qp) override;
  absl::Status encode(const VideoPicture& picture, Reference reference,
                      std::vector<uint8_t>& access_unit) override;

 private:
  struct Free {
    void operator()(AVBufferRef* buffer) const;
    void operator()(AVCodecContext* context) const;
    void operator()(AVFrame* frame) const;
    void operator()(AVPacket* packet) const;
  };
  template <typename Part>
  using Owned = std::unique_ptr<Part, Free>;

  // One attempt: options, and the device of VAAPI, "" = none.
  struct Attempt {
    std::vector<Option> options;
    std::string device;
  };
  static std::vector<Attempt> attemptsOf(const Form& form);
  static absl::StatusOr<std::unique_ptr<VideoEncoder>> tryToMake(const Form& form,
                                                                 const Attempt& attempt,
                                                                 const VideoFormat& format);

  AvcodecEncoder(const Form& form, const Attempt& attempt, const VideoFormat& format);
  absl::Status openDevice();
  absl::Status open();
  absl::Status upload(const VideoPicture& picture);
  absl::Status send(const VideoPicture& picture, bool is_idr);
  absl::Status receive(bool is_idr, std::vector<uint8_t>& access_unit);

  const Form form_;
  const Attempt attempt_;
  VideoFormat format_;
  Owned<AVBufferRef> frames_;  // pictures of the device; none = the encoder takes those of memory
  Owned<AVFrame> frame_;       // what is sent
  Owned<AVFrame> host_frame_;  // the same before it is on the device
  Owned<AVPacket> packet_;
  Owned<AVCodecContext> context_;  // none = to be opened
  int64_t next_time_ = 0;
  bool needs_idr_ = true;  // at the begin, and after an error
};

}  // namespace viewloom
