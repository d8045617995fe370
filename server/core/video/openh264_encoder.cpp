// SPDX-License-Identifier: Apache-2.0
#include "video/openh264_encoder.h"

#include <algorithm>
#include <utility>

#include <wels/codec_api.h>

#include "base/str_cat.h"
#include "video/h264_parameters.h"

namespace viewloom {
namespace {

// Values of disable_deblocking_filter_idc (7.4.3). Across the edges of slices decoders would filter
// in a pass of its own, on one thread.
constexpr int kFilterAll = 0;
constexpr int kFilterWithinSlices = 2;
// Changes no picture at a fixed quantisation. The library raises the level for higher rates, which
// nobody knows before.
constexpr float kNominalRate_hz = 1;

bool isArithmetic(const VideoFormat& format) {
  return format.entropy == EntropyCoding::kArithmetic;
}

absl::Status checkFormat(const VideoFormat& format) {
  VIEWLOOM_RETURN_IF_ERROR(checkVideoFormat(format, {}));
  if (format.thread_count > 1 && !isArithmetic(format) && format.qp < kThreadedQpMin) {
    return absl::InvalidArgumentError(
        strCat("quantisation ", format.qp, " with entropy coding of variable length on ",
               format.thread_count, " threads; accepted is ", kThreadedQpMin, " to ", kVideoQpMax,
               ", or one thread"));
  }
  return absl::OkStatus();
}

void setColor(SSpatialLayerConfig& layer) {
  layer.bVideoSignalTypePresent = true;
  layer.uiVideoFormat = VF_UNDEF;
  layer.bFullRange = true;
  layer.bColorDescriptionPresent = true;
  layer.uiColorPrimaries = CP_BT709;
  layer.uiTransferCharacteristics = TRC_IEC61966_2_1;  // sRGB
  layer.uiColorMatrix = CM_SMPTE170M;
}

uint32_t sliceCount(const VideoFormat& format) {
  return std::max(format.slice_count, format.thread_count);
}

void setLayer(const VideoFormat& format, SSpatialLayerConfig& layer) {
  layer.iVideoWidth = int(format.size_px.width);
  layer.iVideoHeight = int(format.size_px.height);
  layer.fFrameRate = kNominalRate_hz;
  layer.uiProfileIdc = PRO_MAIN;
  layer.uiLevelIdc = ELevelIdc(h264Level(format.size_px));
  layer.iDLayerQp = int(format.qp);
  layer.iSpatialBitrate = UNSPECIFIED_BIT_RATE;
  layer.iMaxSpatialBitrate = UNSPECIFIED_BIT_RATE;
  const bool is_sliced = sliceCount(format) > 1;
  layer.sSliceArgument.uiSliceMode = is_sliced ? SM_FIXEDSLCNUM_SLICE : SM_SINGLE_SLICE;
  layer.sSliceArgument.uiSliceNum = sliceCount(format);
  setColor(layer);
}

// Everything that would choose by itself is off: a picture's bytes depend on nothing but it, the
// picture before it, and the format.
void setParameters(const VideoFormat& format, SEncParamExt& parameters) {
  parameters.iUsageType = CAMERA_VIDEO_REAL_TIME;
  parameters.iPicWidth = int(format.size_px.width);
  parameters.iPicHeight = int(format.size_px.height);
  parameters.fMaxFrameRate = kNominalRate_hz;
  parameters.iRCMode = RC_OFF_MODE;
  parameters.iTargetBitrate = UNSPECIFIED_BIT_RATE;
  parameters.iMaxBitrate = UNSPECIFIED_BIT_RATE;
  parameters.iSpatialLayerNum = 1;
  parameters.iTemporalLayerNum = 1;
  parameters.iComplexityMode = MEDIUM_COMPLEXITY;
  parameters.uiIntraPeriod = 0;
  parameters.iNumRefFrame = 1;
  parameters.eSpsPpsIdStrategy = CONSTANT_ID;
  parameters.iEntropyCodingModeFlag = isArithmetic(format) ? 1 : 0;
  parameters.iLoopFilterDisableIdc = sliceCount(format) > 1 ? kFilterWithinSlices : kFilterAll;
  parameters.iMultipleThreadIdc = uint16_t(format.thread_count);
  parameters.bUseLoadBalancing = false;
  parameters.bEnableFrameSkip = false;
  parameters.bEnableLongTermReference = false;
  parameters.bEnableDenoise = false;
  parameters.bEnableBackgroundDetection = false;
  parameters.bEnableAdaptiveQuant = false;
  parameters.bEnableSceneChangeDetect = false;
  parameters.bEnableFrameCroppingFlag = true;
  parameters.iMinQp = int(format.qp);
  parameters.iMaxQp = int(format.qp);
  setLayer(format, parameters.sSpatialLayers[0]);
}

absl::Status statusOf(int code, std::string_view call) {
  if (code == cmResultSuccess) return absl::OkStatus();
  if (code == cmMallocMemeError) {
    return absl::ResourceExhaustedError("there is no memory for a video encoder");
  }
  return absl::InternalError(strCat("OpenH264: ", call, " failed with code ", code));
}

absl::Status makeParameters(ISVCEncoder& encoder, const VideoFormat& format,
                            SEncParamExt& parameters) {
  VIEWLOOM_RETURN_IF_ERROR(statusOf(encoder.GetDefaultParams(&parameters), "GetDefaultParams"));
  setParameters(format, parameters);
  return absl::OkStatus();
}

void appendUnits(const SFrameBSInfo& coded, std::vector<uint8_t>& access_unit) {
  for (int i = 0; i < coded.iLayerNum; ++i) {
    const SLayerBSInfo& layer = coded.sLayerInfo[i];
    size_t layer_bytes = 0;
    for (int nal = 0; nal < layer.iNalCount; ++nal) {
      layer_bytes += size_t(layer.pNalLengthInByte[nal]);
    }
    access_unit.insert(access_unit.end(), layer.pBsBuf, layer.pBsBuf + layer_bytes);
  }
}

}  // namespace

void OpenH264Encoder::Destroy::operator()(ISVCEncoder* encoder) const {
  encoder->Uninitialize();
  WelsDestroySVCEncoder(encoder);
}

absl::StatusOr<std::unique_ptr<OpenH264Encoder>> OpenH264Encoder::make(const VideoFormat& format) {
  VIEWLOOM_RETURN_IF_ERROR(checkFormat(format));
  ISVCEncoder* made = nullptr;
  if (WelsCreateSVCEncoder(&made) != 0 || made == nullptr) {
    return absl::ResourceExhaustedError("there is no memory for a video encoder");
  }
  EncoderPtr encoder(made);
  int quiet = WELS_LOG_QUIET;
  encoder->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);
  SEncParamExt parameters;
  VIEWLOOM_RETURN_IF_ERROR(makeParameters(*encoder, format, parameters));
  VIEWLOOM_RETURN_IF_ERROR(statusOf(encoder->InitializeExt(&parameters), "InitializeExt"));
  return std::unique_ptr<OpenH264Encoder>(new OpenH264Encoder(format, std::move(encoder)));
}

OpenH264Encoder::OpenH264Encoder(const VideoFormat& format, EncoderPtr encoder)
    : format_(format), encoder_(std::move(encoder)) {}

OpenH264Encoder::~OpenH264Encoder() = default;

// The library takes another quantisation of the layer without a new IDR picture, where all else is
// as it was.
absl::Status OpenH264Encoder::setQp(uint32_t qp) {
  if (qp == format_.qp) return absl::OkStatus();
  VideoFormat format = format_;
  format.qp = qp;
  VIEWLOOM_RETURN_IF_ERROR(checkFormat(format));
  SEncParamExt parameters;
  VIEWLOOM_RETURN_IF_ERROR(makeParameters(*encoder_, format, parameters));
  VIEWLOOM_RETURN_IF_ERROR(
      statusOf(encoder_->SetOption(ENCODER_OPTION_SVC_ENCODE_PARAM_EXT, &parameters), "SetOption"));
  format_ = format;
  return absl::OkStatus();
}

absl::Status OpenH264Encoder::encode(const VideoPicture& picture, Reference reference,
                                     std::vector<uint8_t>& access_unit) {
  access_unit.clear();
  VIEWLOOM_RETURN_IF_ERROR(checkPictureSize(picture, format_));
  if (reference == Reference::kNone) {
    VIEWLOOM_RETURN_IF_ERROR(statusOf(encoder_->ForceIntraFrame(true), "ForceIntraFrame"));
  }
  SSourcePicture source = {};
  source.iColorFormat = videoFormatI420;
  source.iPicWidth = int(picture.size_px.width);
  source.iPicHeight = int(picture.size_px.height);
  source.iStride[0] = int(picture.y_stride_bytes);
  source.iStride[1] = source.iStride[2] = int(picture.chroma_stride_bytes);
  // The library only reads them; its type predates const.
  source.pData[0] = const_cast<uint8_t*>(picture.y);
  source.pData[1] = const_cast<uint8_t*>(picture.cb);
  source.pData[2] = const_cast<uint8_t*>(picture.cr);
  constexpr int64_t kStep_ms = 33;
  source.uiTimeStamp = std::exchange(time_ms_, time_ms_ + kStep_ms);
  SFrameBSInfo coded = {};
  VIEWLOOM_RETURN_IF_ERROR(statusOf(encoder_->EncodeFrame(&source, &coded), "EncodeFrame"));
  const auto asked = reference == Reference::kNone ? videoFrameTypeIDR : coded.eFrameType;
  if (coded.eFrameType != asked || coded.iFrameSizeInBytes == 0) {
    return absl::InternalError("OpenH264: EncodeFrame made no picture of the kind that was asked");
  }
  appendUnits(coded, access_unit);
  return absl::OkStatus();
}

}  // namespace viewloom
