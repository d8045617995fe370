// SPDX-License-Identifier: Apache-2.0
#include "codecs/avcodec_encoder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <utility>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/dict.h>
#include <libavutil/hwcontext.h>
#include <libavutil/log.h>
#include <libavutil/pixfmt.h>
}

#include "base/str_cat.h"
#include "video/uniform_units.h"

namespace viewloom {
namespace {

// Reason of the last failure: libavcodec tells it in its log alone.
thread_local std::string told_reason;

// Keeps the first error of a call: those that follow are its consequences.
void keepReason(void* context, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR || !told_reason.empty()) return;
  char line[256];
  int is_line_begin = 0;
  av_log_format_line2(context, level, format, arguments, line, sizeof line, &is_line_begin);
  told_reason = line;
  while (!told_reason.empty() && (told_reason.back() == '\n' || told_reason.back() == '.')) {
    told_reason.pop_back();
  }
}

void beginCall() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(keepReason); });
  told_reason.clear();
}

// The words of libavcodec, without the address of its object: "[h264_nvenc @ 0x55...] ".
std::string reasonOf(int code) {
  const size_t end = told_reason.find("] ");
  if (!told_reason.empty()) return told_reason.substr(end == std::string::npos ? 0 : end + 2);
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_make_error_string(text, sizeof text, code);
  return text;
}

absl::Status avStatus(int code, std::string_view call) {
  if (code >= 0) return absl::OkStatus();
  if (code == AVERROR(ENOMEM)) {
    return absl::ResourceExhaustedError("there is no memory for a video encoder");
  }
  return absl::InternalError(strCat(call, call.empty() ? "" : ": ", reasonOf(code)));
}

// Everything that would choose by itself is off, as with OpenH264.
void setFormat(const VideoFormat& format, bool takes_slices, AVCodecContext& context) {
  constexpr int kNever = 1 << 30;
  context.width = int(format.size_px.width);
  context.height = int(format.size_px.height);
  context.time_base = {1, 1};  // a nominal rate: higher ones would need higher levels
  context.framerate = {1, 1};
  context.gop_size = kNever;
  context.max_b_frames = 0;
  context.i_quant_factor = 1;  // pictures without a reference have the same quantisation
  context.color_range = AVCOL_RANGE_JPEG;
  context.color_primaries = AVCOL_PRI_BT709;
  context.color_trc = AVCOL_TRC_IEC61966_2_1;  // sRGB
  context.colorspace = AVCOL_SPC_SMPTE170M;
  if (!takes_slices) return;
  context.slices = context.thread_count = int(format.thread_count);
  context.thread_type = FF_THREAD_SLICE;
}

void copyPlane(const uint8_t* from, size_t from_stride, SizePx size_px, uint8_t* to,
               int to_stride) {
  for (uint32_t y = 0; y < size_px.height; ++y) {
    std::copy_n(from + y * from_stride, size_px.width, to + int64_t{y} * to_stride);
  }
}

// The samples of NV12: Cb and Cr side by side.
void copyToNv12(const VideoPicture& picture, AVFrame& frame) {
  copyPlane(picture.y, picture.y_stride_bytes, picture.size_px, frame.data[0], frame.linesize[0]);
  for (uint32_t y = 0; y < picture.size_px.height / 2; ++y) {
    const uint8_t* const cb = picture.cb + y * picture.chroma_stride_bytes;
    const uint8_t* const cr = picture.cr + y * picture.chroma_stride_bytes;
    uint8_t* const out = frame.data[1] + int64_t{y} * frame.linesize[1];
    for (uint32_t x = 0; x < picture.size_px.width / 2; ++x) {
      out[2 * x] = cb[x];
      out[2 * x + 1] = cr[x];
    }
  }
}

// Devices that may encode. The first one of a machine is not always that with an encoder.
std::vector<std::string> renderNodes() {
  std::vector<std::string> nodes;
  std::error_code error;
  for (std::filesystem::directory_iterator entry("/dev/dri", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string path = entry->path();
    if (path.find("/renderD") != std::string::npos) nodes.push_back(path);
  }
  std::ranges::sort(nodes);
  return nodes;
}

}  // namespace

void AvcodecEncoder::Free::operator()(AVBufferRef* buffer) const {
  av_buffer_unref(&buffer);
}
void AvcodecEncoder::Free::operator()(AVCodecContext* context) const {
  avcodec_free_context(&context);
}
void AvcodecEncoder::Free::operator()(AVFrame* frame) const {
  av_frame_free(&frame);
}
void AvcodecEncoder::Free::operator()(AVPacket* packet) const {
  av_packet_free(&packet);
}

std::string AvcodecEncoder::library() {
  const unsigned version = avcodec_version();
  return strCat("libavcodec ", AV_VERSION_MAJOR(version), ".", AV_VERSION_MINOR(version), ".",
                AV_VERSION_MICRO(version));
}

// Some GPUs have only the encoder that libavcodec calls the one of low power.
std::vector<AvcodecEncoder::Attempt> AvcodecEncoder::attemptsOf(const Form& form) {
  if (!form.has_vaapi) return {{.options = form.options, .device = ""}};
  std::vector<Attempt> attempts;
  for (const std::string& device : renderNodes()) {
    for (const char* const low_power : {"0", "1"}) {
      Attempt attempt{.options = form.options, .device = device};
      attempt.options.push_back({"low_power", low_power});
      attempts.push_back(std::move(attempt));
    }
  }
  return attempts;
}

absl::StatusOr<std::unique_ptr<VideoEncoder>> AvcodecEncoder::make(const Form& form,
                                                                   const VideoFormat& format) {
  VIEWLOOM_RETURN_IF_ERROR(checkVideoFormat(format, form.limit));
  absl::Status failure = absl::UnavailableError("there is no device in /dev/dri");
  for (const Attempt& attempt : attemptsOf(form)) {
    auto made = tryToMake(form, attempt, format);
    if (made.ok() || absl::IsResourceExhausted(made.status())) return made;
    failure = absl::UnavailableError(made.status().message());
  }
  return failure;
}

absl::StatusOr<std::unique_ptr<VideoEncoder>> AvcodecEncoder::tryToMake(const Form& form,
                                                                        const Attempt& attempt,
                                                                        const VideoFormat& format) {
  std::unique_ptr<AvcodecEncoder> encoder(new AvcodecEncoder(form, attempt, format));
  if (!encoder->frame_ || !encoder->host_frame_ || !encoder->packet_) {
    return avStatus(AVERROR(ENOMEM), "");
  }
  if (form.has_vaapi) VIEWLOOM_RETURN_IF_ERROR(encoder->openDevice());
  VIEWLOOM_RETURN_IF_ERROR(encoder->open());
  return std::unique_ptr<VideoEncoder>(std::move(encoder));
}

AvcodecEncoder::AvcodecEncoder(const Form& form, const Attempt& attempt, const VideoFormat& format)
    : form_(form),
      attempt_(attempt),
      format_(format),
      frame_(av_frame_alloc()),
      host_frame_(av_frame_alloc()),
      packet_(av_packet_alloc()) {}

AvcodecEncoder::~AvcodecEncoder() = default;

absl::Status AvcodecEncoder::openDevice() {
  constexpr int kPicturesOnDevice = 4;
  beginCall();
  AVBufferRef* opened = nullptr;
  VIEWLOOM_RETURN_IF_ERROR(avStatus(
      av_hwdevice_ctx_create(&opened, AV_HWDEVICE_TYPE_VAAPI, attempt_.device.c_str(), nullptr, 0),
      attempt_.device));
  const Owned<AVBufferRef> owner(opened);
  frames_.reset(av_hwframe_ctx_alloc(opened));
  if (!frames_) return avStatus(AVERROR(ENOMEM), "");
  AVHWFramesContext& frames = *reinterpret_cast<AVHWFramesContext*>(frames_->data);
  frames.format = AV_PIX_FMT_VAAPI;
  frames.sw_format = AV_PIX_FMT_NV12;
  frames.width = int(format_.size_px.width);
  frames.height = int(format_.size_px.height);
  frames.initial_pool_size = kPicturesOnDevice;
  VIEWLOOM_RETURN_IF_ERROR(avStatus(av_hwframe_ctx_init(frames_.get()), attempt_.device));
  host_frame_->format = AV_PIX_FMT_NV12;
  host_frame_->width = frames.width;
  host_frame_->height = frames.height;
  return avStatus(av_frame_get_buffer(host_frame_.get(), 0), "");
}

absl::Status AvcodecEncoder::open() {
  beginCall();
  const AVCodec* const codec = avcodec_find_encoder_by_name(form_.name.c_str());
  if (codec == nullptr) return absl::UnavailableError("libavcodec was built without it");
  Owned<AVCodecContext> context(avcodec_alloc_context3(codec));
  if (!context) return avStatus(AVERROR(ENOMEM), "");
  setFormat(format_, form_.takes_slices, *context);
  context->pix_fmt = frames_ ? AV_PIX_FMT_VAAPI : AV_PIX_FMT_YUV420P;
  if (frames_) context->hw_frames_ctx = av_buffer_ref(frames_.get());
  AVDictionary* options = nullptr;
  av_dict_set_int(&options, "qp", format_.qp, 0);
  for (const Option& option : attempt_.options) {
    av_dict_set(&options, option.name.c_str(), option.value.c_str(), 0);
  }
  const int code = avcodec_open2(context.get(), codec, &options);
  av_dict_free(&options);
  VIEWLOOM_RETURN_IF_ERROR(avStatus(code, attempt_.device));
  context_ = std::move(context);
  needs_idr_ = true;
  return absl::OkStatus();
}

absl::Status AvcodecEncoder::setQp(uint32_t qp) {
  if (qp == format_.qp) return absl::OkStatus();
  VideoFormat format = format_;
  format.qp = qp;
  VIEWLOOM_RETURN_IF_ERROR(checkVideoFormat(format, form_.limit));
  format_ = format;
  context_ = nullptr;  // before the next one is opened: devices have few
  return absl::OkStatus();
}

absl::Status AvcodecEncoder::encode(const VideoPicture& picture, Reference reference,
                                    std::vector<uint8_t>& access_unit) {
  access_unit.clear();
  VIEWLOOM_RETURN_IF_ERROR(checkPictureSize(picture, format_));
  if (!context_) VIEWLOOM_RETURN_IF_ERROR(open());
  const bool is_idr = std::exchange(needs_idr_, true) || reference == Reference::kNone;
  beginCall();
  VIEWLOOM_RETURN_IF_ERROR(send(picture, is_idr));
  VIEWLOOM_RETURN_IF_ERROR(receive(is_idr, access_unit));
  needs_idr_ = false;
  return absl::OkStatus();
}

// Copies the picture to the device.
absl::Status AvcodecEncoder::upload(const VideoPicture& picture) {
  copyToNv12(picture, *host_frame_);
  VIEWLOOM_RETURN_IF_ERROR(
      avStatus(av_hwframe_get_buffer(frames_.get(), frame_.get(), 0), "a picture of the device"));
  return avStatus(av_hwframe_transfer_data(frame_.get(), host_frame_.get(), 0),
                  "a picture to the device");
}

absl::Status AvcodecEncoder::send(const VideoPicture& picture, bool is_idr) {
  AVFrame& frame = *frame_;
  av_frame_unref(&frame);
  if (frames_) {
    VIEWLOOM_RETURN_IF_ERROR(upload(picture));
  } else {
    // The library copies samples that it does not own; its type predates const.
    const std::array<const uint8_t*, 3> planes = {picture.y, picture.cb, picture.cr};
    for (size_t i = 0; i < planes.size(); ++i) {
      frame.data[i] = const_cast<uint8_t*>(planes[i]);
      frame.linesize[i] = int(i == 0 ? picture.y_stride_bytes : picture.chroma_stride_bytes);
    }
    frame.format = AV_PIX_FMT_YUV420P;
    frame.width = int(format_.size_px.width);
    frame.height = int(format_.size_px.height);
  }
  frame.pts = next_time_++;
  frame.pict_type = is_idr ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  frame.color_range = context_->color_range;
  return avStatus(avcodec_send_frame(context_.get(), &frame), "avcodec_send_frame");
}

absl::Status AvcodecEncoder::receive(bool is_idr, std::vector<uint8_t>& access_unit) {
  const int code = avcodec_receive_packet(context_.get(), packet_.get());
  if (code == AVERROR(EAGAIN)) return absl::InternalError("it keeps pictures back");
  VIEWLOOM_RETURN_IF_ERROR(avStatus(code, "avcodec_receive_packet"));
  const std::span<const uint8_t> coded(packet_->data, size_t(packet_->size));
  const absl::Status written = writeUniformUnit(coded, format_.size_px, is_idr, access_unit);
  av_packet_unref(packet_.get());
  return written.ok() ? written : absl::InternalError(written.message());
}

}  // namespace viewloom
