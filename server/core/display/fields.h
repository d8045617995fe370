// SPDX-License-Identifier: Apache-2.0
// Fields of displays, named as in proto Display. Each message has one list of its fields.
//
// A list is a function visitFields(Spec&, Visitor&), beside its struct. Users of all fields visit
// it: the conversion from proto, the checks, the key, the ranges that `viewloom` and the page
// offer. A visitor has these members:
//   (name, value, range)       a number, a size, or an optional number
//   (name, value)              a bool
//   word(name, value, words)   an enum
//   color(name, value)         0xRRGGBB
//   label(name, ...)           text, or an enum with words, that only matters until the display is
//                              completed
//   cameras(name, value, counts), pose(name, value)
//   part(name, value)          a message: an optional spec with a list of its own
//   group(name, function)      a message whose fields are members of the same struct
//   kind(value)                the oneof of proto Display
//   made(function)             a value that completing found and that changes the picture; no field
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/status.h"
#include "frame/camera.h"
#include "frame/size.h"

namespace viewloom {

// A spec, constant or not.
template <typename Type, typename Spec>
concept SpecOf = std::same_as<std::remove_const_t<Type>, Spec>;

// Range of numbers that a field accepts.
struct Range {
  double min = 0;
  double max = 0;
  bool accepts_zero = false;      // 0 means "not given"
  bool accepts_infinity = false;  // although it is beyond `max`
};

// Focal distances stay far inside the range that binary64 squares without loss.
inline constexpr double kFocalDistanceMin_m = 1e-6;
inline constexpr double kFocalDistanceMax_m = 1e9;
inline constexpr double kViewAngleMax_rad = 2.6;  // of a cone or a field of view; tan(1.3) = 3.6

inline constexpr Range kOptionalDistance{kFocalDistanceMin_m, kFocalDistanceMax_m, true};
inline constexpr Range kOptionalAngle{0, kViewAngleMax_rad};
inline constexpr Range kAnyNumber{std::numeric_limits<double>::lowest(),
                                  std::numeric_limits<double>::max()};

// A value of an enum and its name in proto, without the prefix of the enum.
template <typename Value>
struct Word {
  const char* name;
  Value value;
};

// A camera with angles, or with intrinsics in pixels of a tile.
struct ViewCamera {
  Pose pose;  // relative to the display
  std::variant<Fov, Intrinsics> projection;
};

// Refuses a number out of range, and NaN: "got 51; accepted is 1..50". Angles (fields that end in
// "_rad") are told in degrees too, as command lines take them.
absl::Status checkRange(double value, const Range& range, const std::string& field);
// Refuses the length of a list: "got 3 entries; accepted is none or 2".
absl::Status checkCount(size_t count, const Range& counts, const std::string& field);

// A visitor that checks every field. It keeps the first refusal.
class FieldChecks {
 public:
  template <std::floating_point Number>
  void operator()(const char* name, const Number& value, const Range& range) {
    number(name, value, range);
  }
  void operator()(const char* name, uint32_t value, const Range& range) {
    number(name, value, range);
  }
  void operator()(const char* name, SizePx value, const Range& range);
  template <typename Number>
  void operator()(const char* name, const std::optional<Number>& value, const Range& range) {
    if (value) number(name, double{1} * *value, range);
  }
  void operator()(const char*, bool) {}
  template <typename Value, size_t kCount>
  void word(const char*, const Value&, const Word<Value> (&)[kCount]) {}
  template <typename Value, size_t kCount>
  void word(const char*, const std::optional<Value>&, const Word<Value> (&)[kCount]) {}
  template <typename... Parts>
  void label(const char*, const Parts&...) {}
  void color(const char* name, uint32_t value);
  void cameras(const char* name, const std::vector<ViewCamera>& value, const Range& counts);
  void pose(const char* name, const std::optional<Pose>& value);
  template <typename Spec>
  void part(const char* name, const std::optional<Spec>& value) {
    if (value) group(name, [&] { visitFields(*value, *this); });
  }
  template <typename Function>
  void group(const char* name, const Function& visit) {
    const size_t length = prefix_.size();
    prefix_.append(name).append(".");
    visit();
    prefix_.resize(length);
  }
  template <typename Kind>
  void kind(const Kind& value) {
    std::visit([this](const auto& spec) { part(spec.kName, std::optional(spec)); }, value);
  }
  template <typename Function>
  void made(const Function&) {}

  const absl::Status& status() const { return status_; }

 private:
  void number(const char* name, double value, const Range& range);
  void take(const absl::Status& status);

  std::string prefix_;
  absl::Status status_;
};

}  // namespace viewloom
