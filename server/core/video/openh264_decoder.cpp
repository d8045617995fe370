// SPDX-License-Identifier: Apache-2.0
#include "video/openh264_decoder.h"

#include <array>
#include <limits>
#include <utility>

#include <wels/codec_api.h>

#include "base/str_cat.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/video_encoder.h"

namespace viewloom {
namespace {

absl::Status refusePicture(std::string_view problem) {
  return absl::InvalidArgumentError(strCat("H.264: ", problem));
}

std::string textOf(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height, " px");
}

// Others belong to extensions that no encoder of ours uses.
bool isKnown(NalType type) {
  switch (type) {
    case NalType::kSlice:
    case NalType::kIdrSlice:
    case NalType::kSupplement:
    case NalType::kSequenceParameters:
    case NalType::kPictureParameters:
    case NalType::kDelimiter:
      return true;
  }
  return false;
}

absl::Status checkParameters(std::span<const uint8_t> unit, SizePx size_px) {
  const absl::StatusOr<H264Parameters> parameters = parseH264Parameters(unit);
  VIEWLOOM_RETURN_IF_ERROR(parameters.status());
  if (parameters->size_px != size_px) {
    return refusePicture(
        strCat("pictures of ", textOf(parameters->size_px), "; expected are ", textOf(size_px)));
  }
  if (size_px.area() > kVideoAreaMax_px) {
    return refusePicture(
        strCat("pictures of ", textOf(size_px), "; accepted are up to ", kVideoAreaMax_px, " px"));
  }
  if (parameters->reference_count > kVideoReferencesMax) {
    return refusePicture(strCat("it keeps ", parameters->reference_count,
                                " pictures; accepted are up to ", kVideoReferencesMax));
  }
  return absl::OkStatus();
}

}  // namespace

void OpenH264Decoder::Destroy::operator()(ISVCDecoder* decoder) const {
  decoder->Uninitialize();
  WelsDestroyDecoder(decoder);
}

absl::StatusOr<std::unique_ptr<OpenH264Decoder>> OpenH264Decoder::make() {
  ISVCDecoder* made = nullptr;
  if (WelsCreateDecoder(&made) != 0 || made == nullptr) {
    return absl::ResourceExhaustedError("there is no memory for a video decoder");
  }
  std::unique_ptr<OpenH264Decoder> decoder(new OpenH264Decoder(DecoderPtr(made)));
  VIEWLOOM_RETURN_IF_ERROR(decoder->start());
  return decoder;
}

OpenH264Decoder::OpenH264Decoder(DecoderPtr decoder) : decoder_(std::move(decoder)) {}

OpenH264Decoder::~OpenH264Decoder() = default;

absl::Status OpenH264Decoder::start() {
  int quiet = WELS_LOG_QUIET;
  decoder_->SetOption(DECODER_OPTION_TRACE_LEVEL, &quiet);
  SDecodingParam parameters = {};
  parameters.eEcActiveIdc = ERROR_CON_DISABLE;
  parameters.sVideoProperty.size = sizeof(parameters.sVideoProperty);
  parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
  if (decoder_->Initialize(&parameters) != 0) {
    return absl::ResourceExhaustedError("there is no memory for a video decoder");
  }
  return absl::OkStatus();
}

// Nothing of a refused picture stays: neither parameter sets, nor pictures that were not taken.
void OpenH264Decoder::restart() {
  decoder_->Uninitialize();
  is_started_ = start().ok();
}

absl::Status OpenH264Decoder::check(std::span<const uint8_t> access_unit, SizePx size_px) const {
  if (access_unit.size() > size_t{std::numeric_limits<int32_t>::max()}) {
    return refusePicture(strCat("a picture of ", access_unit.size(), " bytes"));
  }
  bool has_picture = false;
  bool has_parameters = false;
  bool is_idr = false;
  for (const NalUnit& unit : nalUnits(access_unit)) {
    if (!isKnown(unit.type())) {
      return refusePicture(strCat("a unit of type ", int(unit.type()), ", which is not accepted"));
    }
    if (unit.type() == NalType::kSequenceParameters) {
      VIEWLOOM_RETURN_IF_ERROR(checkParameters(unit.bytes, size_px));
      has_parameters = true;
    }
    is_idr |= unit.type() == NalType::kIdrSlice;
    has_picture |= is_idr || unit.type() == NalType::kSlice;
  }
  if (!has_picture) return refusePicture("the bytes hold no picture");
  if (needs_idr_ && !is_idr) {
    return refusePicture("the picture refers to one that is missing or damaged");
  }
  // Versions of the library before 2.6 then use memory of another size (CVE-2025-27091).
  if (has_parameters && !is_idr) {
    return refusePicture("sequence parameters before a picture that refers to others");
  }
  return absl::OkStatus();
}

absl::StatusOr<VideoPicture> OpenH264Decoder::decode(std::span<const uint8_t> access_unit,
                                                     SizePx size_px) {
  const absl::Status checked = check(access_unit, size_px);
  needs_idr_ = true;  // until this picture is known to be whole
  VIEWLOOM_RETURN_IF_ERROR(checked);
  if (!is_started_) VIEWLOOM_RETURN_IF_ERROR(start());
  is_started_ = true;
  absl::StatusOr<VideoPicture> picture = decodeChecked(access_unit, size_px);
  needs_idr_ = !picture.ok();
  if (!picture.ok()) restart();
  return picture;
}

absl::StatusOr<VideoPicture> OpenH264Decoder::decodeChecked(std::span<const uint8_t> access_unit,
                                                            SizePx size_px) {
  std::array<unsigned char*, 3> planes = {};
  SBufferInfo info = {};
  const DECODING_STATE state = decoder_->DecodeFrameNoDelay(
      access_unit.data(), int(access_unit.size()), planes.data(), &info);
  if (state == dsOutOfMemory) {
    return absl::ResourceExhaustedError("there is no memory for a decoded picture");
  }
  // The library keeps each picture of the main profile for the next call, whatever the parameter
  // set says about the order.
  if (state == dsErrorFree && info.iBufferStatus != 1) decoder_->FlushFrame(planes.data(), &info);
  if (state != dsErrorFree || info.iBufferStatus != 1) {
    return refusePicture(strCat("the picture is damaged (decoding state ", int(state), ")"));
  }
  int kept_count = 0;
  decoder_->GetOption(DECODER_OPTION_NUM_OF_FRAMES_REMAINING_IN_BUFFER, &kept_count);
  if (kept_count != 0) return refusePicture("the bytes hold more than one picture");
  const SSysMEMBuffer& memory = info.UsrData.sSystemBuffer;
  const SizePx decoded_px = {uint32_t(memory.iWidth), uint32_t(memory.iHeight)};
  if (decoded_px != size_px) {
    return refusePicture(
        strCat("a picture of ", textOf(decoded_px), "; expected is ", textOf(size_px)));
  }
  return VideoPicture{.size_px = size_px,
                      .y = planes[0],
                      .cb = planes[1],
                      .cr = planes[2],
                      .y_stride_bytes = size_t(memory.iStride[0]),
                      .chroma_stride_bytes = size_t(memory.iStride[1])};
}

}  // namespace viewloom
