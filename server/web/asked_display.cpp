// SPDX-License-Identifier: Apache-2.0
#include "web/asked_display.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "absl/strings/str_join.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "display/named_display.h"
#include "messages/message_from_json.h"

namespace viewloom {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr const char* kUsualPreset = "portrait";
// Longer than any URL that the server reads: the limit of headers comes first.
constexpr size_t kJsonBytesMax = size_t{1} << 20;

constexpr std::array kByHand = {"preset", "width", "height"};

absl::Status checkKnown(const QueryParameters& parameters) {
  std::vector<std::string> names = {"stream", "display", "encoding", "accepted"};
  names.insert(names.end(), kByHand.begin(), kByHand.end());
  for (const auto& [name, value] : parameters) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string nearest = didYouMean(name, names);
    return invalidField(quotable(name), strCat("there is no such parameter; known parameters: ",
                                               absl::StrJoin(names, ", "),
                                               nearest.empty() ? "" : strCat("; ", nearest),
                                               ". Write the fields of a display as JSON: "
                                               "display={\"quilt\":{\"preset\":\"portrait\"}}"));
  }
  return absl::OkStatus();
}

// Leaves the message alone when the parameter is not given.
absl::Status readMessage(const QueryParameters& parameters, const char* name, Message& message) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return absl::OkStatus();
  return withFieldPrefix(messageFromJson(found->second, kJsonBytesMax, message), name);
}

// None when the parameter is not given.
absl::StatusOr<AcceptedEncodings> readAccepted(const QueryParameters& parameters) {
  v1::OpenDisplay opening;
  if (const auto found = parameters.find("accepted"); found != parameters.end()) {
    // JSON of protobuf has lists as fields of messages only.
    const absl::Status status =
        messageFromJson(strCat("{\"accepted\": ", found->second, "}"), kJsonBytesMax, opening);
    if (!status.ok() && fieldOf(status).empty()) return withFieldPrefix(status, "accepted");
    VIEWLOOM_RETURN_IF_ERROR(status);
  }
  return opening.accepted();
}

// 0 when the parameter is not given.
absl::StatusOr<uint32_t> readSide(const QueryParameters& parameters, const char* name) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return uint32_t{0};
  const std::string& text = found->second;
  uint32_t side_px = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side_px);
  if (error == std::errc() && end == text.data() + text.size()) return side_px;
  return invalidField(name,
                      strCat("got \"", quotable(text), "\"; accepted is a whole number of pixels"));
}

// The field of a kind that says how large it is.
const FieldDescriptor* sizeField(const Message& kind) {
  const google::protobuf::Descriptor& type = *kind.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.message_type() == v1::SizePx::descriptor() && !field.is_repeated()) return &field;
  }
  return nullptr;
}

// A device by its name, in a size of its own where one is given.
absl::Status openDevice(const std::string& preset, const v1::SizePx& size, v1::Display& display) {
  const absl::StatusOr<DisplayKind> named = namedDisplay(preset);
  VIEWLOOM_RETURN_IF_ERROR(named.status());
  const char* const name = std::visit([](const auto& kind) { return kind.kName; }, *named);
  const FieldDescriptor& field = *v1::Display::descriptor()->FindFieldByName(name);
  Message& kind = *display.GetReflection()->MutableMessage(&display, &field);
  kind.GetReflection()->SetString(&kind, kind.GetDescriptor()->FindFieldByName("preset"), preset);
  const FieldDescriptor* const side = sizeField(kind);
  if (side == nullptr || (size.width() == 0 && size.height() == 0)) return absl::OkStatus();
  kind.GetReflection()->MutableMessage(&kind, side)->CopyFrom(size);
  return absl::OkStatus();
}

absl::Status readByHand(const QueryParameters& parameters, v1::Display& display) {
  const auto preset = parameters.find("preset");
  v1::SizePx size;
  const absl::StatusOr<uint32_t> width_px = readSide(parameters, "width");
  VIEWLOOM_RETURN_IF_ERROR(width_px.status());
  size.set_width(*width_px);
  const absl::StatusOr<uint32_t> height_px = readSide(parameters, "height");
  VIEWLOOM_RETURN_IF_ERROR(height_px.status());
  size.set_height(*height_px);
  return openDevice(preset == parameters.end() ? kUsualPreset : preset->second, size, display);
}

}  // namespace

absl::StatusOr<AskedDisplay> askedDisplay(const QueryParameters& parameters) {
  VIEWLOOM_RETURN_IF_ERROR(checkKnown(parameters));
  AskedDisplay asked;
  if (const auto stream = parameters.find("stream"); stream != parameters.end()) {
    asked.stream = stream->second;
  }
  VIEWLOOM_RETURN_IF_ERROR(readMessage(parameters, "encoding", asked.encoding));
  absl::StatusOr<AcceptedEncodings> accepted = readAccepted(parameters);
  VIEWLOOM_RETURN_IF_ERROR(accepted.status());
  asked.accepted = *std::move(accepted);
  if (!parameters.contains("display")) {
    VIEWLOOM_RETURN_IF_ERROR(readByHand(parameters, asked.display));
    return asked;
  }
  for (const char* name : kByHand) {
    if (!parameters.contains(name)) continue;
    return invalidField(name, strCat(name, " and display are given; accepted is one of the two"));
  }
  VIEWLOOM_RETURN_IF_ERROR(readMessage(parameters, "display", asked.display));
  return asked;
}

absl::Status inParameters(const absl::Status& status, const QueryParameters& parameters) {
  const std::string field = fieldOf(status);
  const std::string name = field.substr(field.rfind('.') + 1);
  if (parameters.contains("display") || !parameters.contains(name)) return status;
  const std::string_view message(status.message().data(), status.message().size());
  const std::string_view problem = message.substr(message.find(": ") + 2);
  return fieldError(status.code(), name, problem);
}

}  // namespace viewloom
