// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "absl/strings/str_format.h"
#include "base/str_cat.h"
#include "display/display_spec.h"

namespace viewloom {
namespace {

// A visitor that writes every field that changes the picture, in the order of the lists, each
// followed by a blank; numbers in hexadecimal, so that none is rounded.
class KeyText {
 public:
  void add(double value) {
    absl::StrAppendFormat(&text_, "%a ", value + 0.0);  // -0 becomes 0
  }
  void add(uint32_t value) { text_ += strCat(value, " "); }

  template <typename Number>
  void operator()(const char*, const Number& value, const Range&) {
    add(value);
  }
  void operator()(const char*, SizePx value, const Range&) {
    add(value.width);
    add(value.height);
  }
  template <typename Number>
  void operator()(const char*, const std::optional<Number>& value, const Range&) {
    add(static_cast<uint32_t>(value.has_value()));
    if (value) add(*value);
  }
  void operator()(const char*, bool value) { add(static_cast<uint32_t>(value)); }
  template <typename Value, size_t kCount>
  void word(const char*, const Value& value, const Word<Value> (&)[kCount]) {
    add(static_cast<uint32_t>(value));
  }
  template <typename Value, size_t kCount>
  void word(const char*, const std::optional<Value>& value, const Word<Value> (&)[kCount]) {
    text_ += value ? strCat(static_cast<uint32_t>(*value), " ") : "none ";
  }
  template <typename... Parts>
  void label(const char*, const Parts&...) {}
  void color(const char*, uint32_t value) { add(value); }
  void cameras(const char*, const std::vector<ViewCamera>& value, const Range&) {
    add(static_cast<uint32_t>(value.size()));
    for (const ViewCamera& camera : value) {
      add(camera.pose);
      std::visit([this](const auto& projection) { add(projection); }, camera.projection);
    }
  }
  void pose(const char*, const std::optional<Pose>& value) {
    add(static_cast<uint32_t>(value.has_value()));
    if (value) add(*value);
  }
  template <typename Spec>
  void part(const char* name, const std::optional<Spec>& value) {
    if (value) group(name, [&] { visitFields(*value, *this); });
  }
  template <typename Function>
  void group(const char* name, const Function& visit) {
    text_ += strCat(name, " ");
    visit();
  }
  void kind(const DisplayKind& value) {
    std::visit([this](const auto& spec) { part(spec.kName, std::optional(spec)); }, value);
  }
  template <typename Function>
  void made(const Function& text) {
    text_ += strCat(text(), " ");
  }

  std::string take() { return std::move(text_); }

 private:
  void add(const Pose& pose) {
    for (int i = 0; i < 3; ++i) add(pose.position_m[i]);
    for (int i = 0; i < 4; ++i) add(pose.orientation[i]);
  }
  void add(const Fov& fov) {
    text_ += "fov ";
    for (const double angle : {fov.left_rad, fov.right_rad, fov.up_rad, fov.down_rad}) add(angle);
  }
  void add(const Intrinsics& intrinsics) {
    text_ += "px ";
    for (int i = 0; i < 2; ++i) add(intrinsics.focal_px[i]);
    for (int i = 0; i < 2; ++i) add(intrinsics.principal_px[i]);
  }

  std::string text_;
};

}  // namespace

std::string displayKey(const DisplaySpec& spec) {
  KeyText key;
  visitFields(spec, key);
  return key.take();
}

// Chained atlases have pictures in an order of their own, each atlas after the one before.
std::string arrangementKey(const EncodingSpec& encoding) {
  if (isChained(encoding)) return "chained ";
  return encoding.color == BandEncoding::kH264 ? "stacked " : "";
}

std::string encodingKey(const EncodingSpec& encoding) {
  KeyText key;
  key.add(static_cast<uint32_t>(encoding.color));
  const bool is_jpeg = encoding.color == BandEncoding::kJpeg;
  if (is_jpeg || encoding.color == BandEncoding::kJpegPlanes) key.add(encoding.jpeg_quality);
  if (is_jpeg) key.add(static_cast<uint32_t>(encoding.chroma));
  if (encoding.color == BandEncoding::kH264) {
    key.add(encoding.video_qp);
    key.add(static_cast<uint32_t>(encoding.prediction));
  }
  if (adaptsToLines(encoding)) {
    key.add(encoding.video_qp_max);
    key.add(static_cast<double>(encoding.bits_per_second_max));
    key.add(static_cast<uint32_t>(encoding.rung));
  }
  key.add(static_cast<uint32_t>(encoding.with_depth));
  key.add(static_cast<uint32_t>(encoding.with_mask));
  key.add(static_cast<uint32_t>(encoding.with_depth_codes));
  if (encoding.with_depth || encoding.with_mask || encoding.with_depth_codes) {
    key.add(static_cast<uint32_t>(encoding.planes));
  }
  return key.take();
}

}  // namespace viewloom
