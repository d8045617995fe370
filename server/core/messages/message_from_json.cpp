// SPDX-License-Identifier: Apache-2.0
#include "messages/message_from_json.h"

#include <google/protobuf/util/json_util.h>

#include <string>

#include "base/str_cat.h"
#include "messages/json_fields.h"

namespace viewloom {
namespace {

// protobuf prints the place below its sentence, over two lines: "Unexpected token.\nabc\n^".
std::string inOneLine(const std::string& problem) {
  const size_t end = problem.find('\n');
  if (end == std::string::npos) return problem;
  const std::string place = problem.substr(end + 1, problem.find('\n', end + 1) - end - 1);
  const std::string sentence = problem.substr(0, end - (problem[end - 1] == '.' ? 1 : 0));
  return place.empty() ? sentence : strCat(sentence, " at \"", place, "\"");
}

}  // namespace

absl::Status messageFromJson(std::string_view text, size_t bytes_max,
                             google::protobuf::Message& message) {
  if (text.size() > bytes_max) {
    return absl::InvalidArgumentError(
        strCat("the text has ", text.size(), " bytes; accepted is up to ", bytes_max));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkJsonFields(text, *message.GetDescriptor()));
  const auto parsed = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(text.data(), text.size()), &message);
  if (parsed.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(inOneLine(std::string(parsed.message())));
}

}  // namespace viewloom
