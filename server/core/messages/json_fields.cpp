// SPDX-License-Identifier: Apache-2.0
#include "messages/json_fields.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.pb.h>
#include <nlohmann/json.hpp>

#include "absl/strings/numbers.h"
#include "absl/strings/str_join.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using nlohmann::json;

constexpr size_t kValueBytesMax = 40;  // of a value that an error quotes

std::string inQuotes(std::string_view text) {
  return strCat("\"", quotable(text, kValueBytesMax), "\"");
}

bool isWhole(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_UINT32:
    case FieldDescriptor::CPPTYPE_UINT64:
      return true;
    default:
      return false;
  }
}

bool isNumber(const FieldDescriptor& field) {
  return isWhole(field) || field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
}

bool isUnsigned(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32 ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_UINT64;
}

std::vector<std::string> namesOf(const EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.value_count(); ++i) names.push_back(type.value(i)->name());
  return names;
}

std::string acceptedBy(const FieldDescriptor& field) {
  if (isUnsigned(field)) return "a whole number, 0 or more";
  if (isWhole(field)) return "a whole number";
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_FLOAT:
      return "a number";
    case FieldDescriptor::CPPTYPE_BOOL:
      return "true or false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return strCat("one of ", absl::StrJoin(namesOf(*field.enum_type()), ", "));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return "an object in braces";
    default:
      return "a text in quotes";
  }
}

// Messages that protobuf's JSON writes in a way of their own, and maps, are left to its reader.
bool isPlain(const Descriptor& type) {
  return !type.options().map_entry() && type.file()->package() != "google.protobuf";
}

// Handles what nlohmann's reader meets. It ends the reading by returning false.
class FieldWalk final : public nlohmann::json_sax<json> {
 public:
  explicit FieldWalk(const Descriptor& type) : type_(type) {}

  absl::Status status() const { return status_; }

  bool null() override { return true; }
  bool boolean(bool value) override {
    return fits(value ? "true" : "false", [](const auto& field) {
      return field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL;
    });
  }
  bool number_integer(number_integer_t value) override {
    return fits(std::to_string(value), [&](const FieldDescriptor& field) {
      return (isNumber(field) && !(isUnsigned(field) && value < 0)) || isEnum(field);
    });
  }
  bool number_unsigned(number_unsigned_t value) override {
    return fits(std::to_string(value), [&](const FieldDescriptor& field) {
      const bool is_small = field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
      if (is_small && value > std::numeric_limits<uint32_t>::max()) return false;
      return isNumber(field) || isEnum(field);
    });
  }
  bool number_float(number_float_t value, const string_t& text) override {
    return fits(text, [&](const FieldDescriptor& field) {
      if (!isWhole(field)) return isNumber(field);
      return value == std::floor(value) && value >= 0 &&
             value <= double{std::numeric_limits<uint32_t>::max()};
    });
  }
  bool string(string_t& value) override {
    return fits(inQuotes(value), [&](const FieldDescriptor& field) {
      if (isEnum(field)) return field.enum_type()->FindValueByName(value) != nullptr;
      double number = 0;
      if (isNumber(field)) return absl::SimpleAtod(value, &number);
      return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
    });
  }
  bool binary(binary_t&) override { return true; }

  bool start_object(size_t) override {
    if (frames_.empty() && ignored_ == 0) {
      frames_.push_back({.type = &type_, .path = "", .seen = {}});
      return true;
    }
    if (ignored_ > 0 || !isOpen()) return ++ignored_ > 0;
    const FieldDescriptor& field = *frames_.back().field;
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (!is_message || isMissingArray()) return refuseValue("an object");
    if (!isPlain(*field.message_type())) return ++ignored_ > 0;
    frames_.push_back({.type = field.message_type(), .path = path() + ".", .seen = {}});
    return true;
  }
  bool end_object() override {
    if (ignored_ > 0) {
      --ignored_;
    } else {
      frames_.pop_back();
      countElement();
    }
    return true;
  }
  bool key(string_t& name) override {
    if (ignored_ > 0) return true;
    Frame& frame = frames_.back();
    frame.field = frame.type->FindFieldByName(name);
    if (frame.field == nullptr) frame.field = byJsonName(*frame.type, name);
    frame.index = kNoArray;
    if (frame.field == nullptr) return refuseName(name);
    if (frame.seen.insert(frame.field).second) return true;
    return refuse(frame.path + frame.field->name(), "is given twice; accepted is once");
  }
  bool start_array(size_t) override {
    if (frames_.empty() && ignored_ == 0) return refuse("", "got a list; accepted is an object");
    if (ignored_ > 0) return ++ignored_ > 0;
    Frame& frame = frames_.back();
    if (!frame.field->is_repeated() || frame.index != kNoArray) return refuseValue("a list");
    frame.index = 0;
    return true;
  }
  bool end_array() override {
    if (ignored_ > 0)
      --ignored_;
    else
      frames_.back().index = kNoArray;
    return true;
  }
  bool parse_error(size_t position, const std::string& token,
                   const nlohmann::detail::exception&) override {
    return refuse("", strCat("the text is not valid JSON at byte ", position,
                             token.empty() ? "" : strCat(", near ", inQuotes(token))));
  }

 private:
  static constexpr int kNoArray = -1;

  // An object that is open: its type, and the field that was named last.
  struct Frame {
    const Descriptor* type;
    std::string path;  // ends with a dot, but for the outermost
    std::set<const FieldDescriptor*> seen;
    const FieldDescriptor* field = nullptr;
    int index = kNoArray;  // of the next element, in a list
  };

  static bool isEnum(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM;
  }
  static const FieldDescriptor* byJsonName(const Descriptor& type, const std::string& name) {
    for (int i = 0; i < type.field_count(); ++i) {
      if (type.field(i)->json_name() == name) return type.field(i);
    }
    return nullptr;
  }

  bool isOpen() const { return !frames_.empty() && frames_.back().field != nullptr; }
  bool isMissingArray() const {
    const Frame& frame = frames_.back();
    return frame.field->is_repeated() && frame.index == kNoArray;
  }
  std::string path() const {
    const Frame& frame = frames_.back();
    const std::string name = frame.path + frame.field->name();
    return frame.index == kNoArray ? name : strCat(name, "[", frame.index, "]");
  }
  void countElement() {
    if (!frames_.empty() && frames_.back().index != kNoArray) ++frames_.back().index;
  }

  template <typename Accepts>
  bool fits(const std::string& value, const Accepts& accepts) {
    if (ignored_ > 0) return true;
    if (frames_.empty()) return refuse("", strCat("got ", value, "; accepted is an object"));
    const FieldDescriptor& field = *frames_.back().field;
    const bool is_own =
        field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !isPlain(*field.message_type());
    if (isMissingArray() || (!is_own && !accepts(field))) return refuseValue(value);
    countElement();
    return true;
  }
  bool refuseValue(const std::string& value) {
    const FieldDescriptor& field = *frames_.back().field;
    std::string problem = strCat("got ", value, "; accepted is ", acceptedBy(field));
    if (isMissingArray()) problem = strCat("got ", value, "; accepted is a list in brackets");
    if (isEnum(field) && !isMissingArray()) {
      const std::string word = value.size() > 1 ? value.substr(1, value.size() - 2) : value;
      const std::string nearest = didYouMean(word, namesOf(*field.enum_type()));
      if (!nearest.empty()) problem += strCat("; ", nearest);
    }
    return refuse(path(), problem);
  }
  bool refuseName(const std::string& name) {
    const Frame& frame = frames_.back();
    std::vector<std::string> names;
    for (int i = 0; i < frame.type->field_count(); ++i) {
      names.push_back(frame.type->field(i)->name());
    }
    const std::string nearest = didYouMean(name, names);
    return refuse(frame.path + quotable(name, kValueBytesMax),
                  strCat("there is no such field; known fields: ", absl::StrJoin(names, ", "),
                         nearest.empty() ? "" : strCat("; ", nearest)));
  }
  bool refuse(const std::string& field, const std::string& problem) {
    status_ = field.empty() ? absl::InvalidArgumentError(problem) : invalidField(field, problem);
    return false;
  }

  const Descriptor& type_;
  std::vector<Frame> frames_;
  size_t ignored_ = 0;  // objects and lists that are open and left to protobuf's reader
  absl::Status status_;
};

}  // namespace

absl::Status checkJsonFields(std::string_view text, const Descriptor& type) {
  FieldWalk walk(type);
  json::sax_parse(text.begin(), text.end(), &walk);
  return walk.status();
}

}  // namespace viewloom
