// SPDX-License-Identifier: Apache-2.0
#include "messages/display_from_proto.h"

#include <google/protobuf/descriptor.h>

#include <string>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/named_display.h"
#include "display/rgbd.h"
#include "messages/enum_from_proto.h"
#include "messages/source_from_proto.h"

namespace viewloom {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr std::string_view kUnspecified = "UNSPECIFIED";

absl::StatusOr<std::vector<ViewCamera>> camerasFromProto(const Message& message,
                                                         const FieldDescriptor& field) {
  std::vector<ViewCamera> cameras;
  const Reflection& reflection = *message.GetReflection();
  for (int i = 0; i < reflection.FieldSize(message, &field); ++i) {
    const auto& proto =
        static_cast<const v1::Camera&>(reflection.GetRepeatedMessage(message, &field, i));
    const std::string path = strCat(field.name(), "[", i, "]");
    const auto pose = poseFromProto(proto.pose(), "pose");
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(pose.status(), path));
    const auto projection = projectionFromProto(proto);
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(projection.status(), path));
    cameras.push_back({.pose = *pose, .projection = *projection});
  }
  return cameras;
}

std::string namesOf(const google::protobuf::OneofDescriptor& kinds) {
  std::string names;
  for (int i = 0; i < kinds.field_count(); ++i) {
    if (i > 0) names += i + 1 == kinds.field_count() ? " or " : ", ";
    names += kinds.field(i)->name();
  }
  return names;
}

// A visitor that takes every field that the message gives (display/fields.h). What it does not
// give, and what is 0 there, stays as it is. It keeps the first refusal.
class ProtoReader {
 public:
  explicit ProtoReader(const Message& message) : message_(&message) {}

  void operator()(const char* name, double& value, const Range&) {
    const FieldDescriptor& field = fieldOf(name);
    if (has(field)) value = reflection().GetDouble(*message_, &field);
  }
  void operator()(const char* name, uint32_t& value, const Range&) {
    const FieldDescriptor& field = fieldOf(name);
    if (has(field)) value = reflection().GetUInt32(*message_, &field);
  }
  template <typename Number>
  void operator()(const char* name, std::optional<Number>& value, const Range& range) {
    if (has(fieldOf(name))) (*this)(name, value.emplace(), range);
  }
  void operator()(const char* name, SizePx& value, const Range&) {
    const FieldDescriptor& field = fieldOf(name);
    if (!has(field)) return;
    const Message& size = reflection().GetMessage(*message_, &field);
    value = sizeFromProto(static_cast<const v1::SizePx&>(size));
  }
  void operator()(const char* name, bool& value) {
    value = reflection().GetBool(*message_, &fieldOf(name));
  }
  template <typename Value, typename Known, size_t kCount>
  void word(const char* name, Value& value, const Word<Known> (&words)[kCount]) {
    const FieldDescriptor& field = fieldOf(name);
    if (!has(field)) return;
    std::vector<std::string> known;
    for (const Word<Known>& word : words) known.emplace_back(word.name);
    if (const auto index = wordIndex(field, known)) value = words[*index].value;
  }
  void label(const char* name, std::string& value) {
    value = reflection().GetString(*message_, &fieldOf(name));
  }
  template <typename Value, size_t kCount>
  void label(const char* name, Value& value, const Word<Value> (&words)[kCount]) {
    word(name, value, words);
  }
  void color(const char* name, uint32_t& value) { (*this)(name, value, Range{}); }
  void cameras(const char* name, std::vector<ViewCamera>& value, const Range& counts) {
    const FieldDescriptor& field = fieldOf(name);
    const auto count = size_t(reflection().FieldSize(*message_, &field));
    if (const absl::Status status = checkCount(count, counts, name); !status.ok()) {
      return take(status);
    }
    absl::StatusOr<std::vector<ViewCamera>> cameras = camerasFromProto(*message_, field);
    take(cameras.status());
    if (cameras.ok()) value = *std::move(cameras);
  }
  void pose(const char* name, std::optional<Pose>& value) {
    const FieldDescriptor& field = fieldOf(name);
    if (!has(field)) return;
    const Message& pose = reflection().GetMessage(*message_, &field);
    const auto taken = poseFromProto(static_cast<const v1::Pose&>(pose), name);
    take(taken.status());
    if (taken.ok()) value = *taken;
  }
  template <typename Spec>
  void part(const char* name, std::optional<Spec>& value) {
    if (!has(fieldOf(name))) return;
    Spec spec;
    group(name, [&] { visitFields(spec, *this); });
    value = std::move(spec);
  }
  template <typename Function>
  void group(const char* name, const Function& visit) {
    const FieldDescriptor& field = fieldOf(name);
    if (!has(field)) return;
    const Message* const outer =
        std::exchange(message_, &reflection().GetMessage(*message_, &field));
    const size_t length = prefix_.size();
    prefix_.append(name).append(".");
    visit();
    prefix_.resize(length);
    message_ = outer;
  }
  void kind(DisplayKind& value) {
    const auto& kinds = *message_->GetDescriptor()->FindOneofByName("kind");
    const FieldDescriptor* const given = reflection().GetOneofFieldDescriptor(*message_, &kinds);
    if (given == nullptr) {
      take(invalidField("kind",
                        strCat("the display has no kind; accepted is one of ", namesOf(kinds))));
    } else if (given->type() == FieldDescriptor::TYPE_STRING) {
      absl::StatusOr<DisplayKind> named = namedDisplay(reflection().GetString(*message_, given));
      take(named.status());
      if (named.ok()) value = *std::move(named);
    } else {
      forEachKind([&](auto spec) {
        if (given->name() != spec.kName) return;
        std::optional<decltype(spec)> taken;
        part(spec.kName, taken);
        value = *std::move(taken);
      });
    }
  }
  template <typename Function>
  void made(const Function&) {}

  const absl::Status& status() const { return status_; }

 private:
  const Reflection& reflection() const { return *message_->GetReflection(); }
  const FieldDescriptor& fieldOf(const char* name) const {
    const FieldDescriptor* const field = message_->GetDescriptor()->FindFieldByName(name);
    VIEWLOOM_CHECK(field != nullptr);
    return *field;
  }
  bool has(const FieldDescriptor& field) const { return reflection().HasField(*message_, &field); }

  // Which of the words the enum says; none where it says nothing.
  std::optional<size_t> wordIndex(const FieldDescriptor& field,
                                  const std::vector<std::string>& words) {
    const google::protobuf::EnumDescriptor& type = *field.enum_type();
    std::string prefix = type.FindValueByNumber(0)->name();
    prefix.resize(prefix.size() - kUnspecified.size());
    const int number = reflection().GetEnumValue(*message_, &field);
    std::string accepted;
    for (size_t i = 0; i < words.size(); ++i) {
      const auto* const value = type.FindValueByName(prefix + words[i]);
      VIEWLOOM_CHECK(value != nullptr);
      if (value->number() == number) return i;
      accepted += strCat(i == 0 ? "" : ", ", value->name());
    }
    take(refuseEnum(type, number, accepted, field.name()));
    return std::nullopt;
  }

  void take(const absl::Status& status) {
    if (!status_.ok() || status.ok()) return;
    status_ =
        prefix_.empty()
            ? status
            : withFieldPrefix(status, std::string_view(prefix_).substr(0, prefix_.size() - 1));
  }

  const Message* message_;
  std::string prefix_;
  absl::Status status_;
};

constexpr EnumRow<v1::BandEncoding, BandEncoding> kColorEncodings[] = {
    {v1::BAND_ENCODING_UNSPECIFIED, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG_PLANES, BandEncoding::kJpegPlanes},
    {v1::BAND_ENCODING_ZSTD, BandEncoding::kZstd},
    {v1::BAND_ENCODING_RAW, BandEncoding::kRaw},
    {v1::BAND_ENCODING_H264, BandEncoding::kH264},
    {v1::BAND_ENCODING_COMPACT_DEPTH, BandEncoding::kCompactDepth}};

constexpr EnumRow<v1::BandEncoding, BandEncoding> kPlaneEncodings[] = {
    {v1::BAND_ENCODING_UNSPECIFIED, BandEncoding::kZstd},
    {v1::BAND_ENCODING_JPEG, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG_PLANES, BandEncoding::kJpegPlanes},
    {v1::BAND_ENCODING_ZSTD, BandEncoding::kZstd},
    {v1::BAND_ENCODING_RAW, BandEncoding::kRaw},
    {v1::BAND_ENCODING_H264, BandEncoding::kH264},
    {v1::BAND_ENCODING_COMPACT_DEPTH, BandEncoding::kCompactDepth}};

constexpr EnumRow<v1::ChromaSubsampling, Chroma> kChromas[] = {
    {v1::CHROMA_SUBSAMPLING_UNSPECIFIED, Chroma::k420},
    {v1::CHROMA_SUBSAMPLING_420, Chroma::k420},
    {v1::CHROMA_SUBSAMPLING_444, Chroma::k444}};

constexpr EnumRow<v1::Prediction, Prediction> kPredictions[] = {
    {v1::PREDICTION_UNSPECIFIED, Prediction::kWithinAtlas},
    {v1::PREDICTION_WITHIN_ATLAS, Prediction::kWithinAtlas},
    {v1::PREDICTION_ACROSS_ATLASES, Prediction::kAcrossAtlases}};

// A quantisation that is given alone stays.
void setQuality(const v1::AtlasEncoding& proto, EncodingSpec& encoding) {
  if (proto.video_qp() != 0) encoding.video_qp = proto.video_qp();
  if (encoding.color != BandEncoding::kH264) return;
  if (proto.video_qp() == 0) encoding.video_qp = matchedVideoQp(encoding.jpeg_quality);
  encoding.bits_per_second_max = proto.bits_per_second_max();
  const bool adapts = proto.video_qp() == 0 || proto.bits_per_second_max() != 0;
  if (adapts) encoding.video_qp_max = coarsestAdaptedQp(encoding.video_qp);
}

}  // namespace

absl::StatusOr<DisplaySpec> displayFromProto(const v1::Display& proto) {
  DisplaySpec spec;
  ProtoReader reader(proto);
  visitFields(spec, reader);
  VIEWLOOM_RETURN_IF_ERROR(reader.status());
  return completeDisplaySpec(std::move(spec));
}

absl::StatusOr<EncodingSpec> encodingFromProto(const v1::AtlasEncoding& proto,
                                               const DisplaySpec& display) {
  EncodingSpec encoding;
  const auto color = enumFromProto(proto.color(), "color", kColorEncodings);
  VIEWLOOM_RETURN_IF_ERROR(color.status());
  const auto chroma = enumFromProto(proto.chroma(), "chroma", kChromas);
  VIEWLOOM_RETURN_IF_ERROR(chroma.status());
  const auto planes = enumFromProto(proto.planes(), "planes", kPlaneEncodings);
  VIEWLOOM_RETURN_IF_ERROR(planes.status());
  const auto prediction = enumFromProto(proto.prediction(), "prediction", kPredictions);
  VIEWLOOM_RETURN_IF_ERROR(prediction.status());
  encoding.prediction = *prediction;
  encoding.color = *color;
  encoding.chroma = *chroma;
  const bool has_channels = tileGridOf(display).rays_per_px > 1;  // shared chroma would mix them
  if (has_channels) {
    if (proto.color() == v1::BAND_ENCODING_UNSPECIFIED) encoding.color = BandEncoding::kJpegPlanes;
    if (proto.chroma() == v1::CHROMA_SUBSAMPLING_UNSPECIFIED) encoding.chroma = Chroma::k444;
  }
  // Colour that greys share chroma with shows at their edge.
  if (showsDepth(display) && proto.chroma() == v1::CHROMA_SUBSAMPLING_UNSPECIFIED) {
    encoding.chroma = Chroma::k444;
  }
  encoding.with_depth_codes = hasDepthPlane(display);
  encoding.planes = *planes;
  if (proto.jpeg_quality() != 0) encoding.jpeg_quality = proto.jpeg_quality();
  setQuality(proto, encoding);
  encoding.with_depth = proto.with_depth();
  encoding.with_mask = proto.with_mask();
  VIEWLOOM_RETURN_IF_ERROR(validateEncodingSpec(encoding));
  VIEWLOOM_RETURN_IF_ERROR(validateEncodingOf(display, encoding));
  return encoding;
}

}  // namespace viewloom
