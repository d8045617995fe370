// SPDX-License-Identifier: Apache-2.0
#include "cli/print_json.h"

#include <google/protobuf/util/json_util.h>

#include <cstdio>
#include <string>

#include "base/check.h"

namespace viewloom::cli {

absl::Status printJson(const google::protobuf::Message& message) {
  std::string json;
  google::protobuf::util::JsonPrintOptions print_options;
  print_options.add_whitespace = true;
  print_options.always_print_primitive_fields = true;
  const auto printed = google::protobuf::util::MessageToJsonString(message, &json, print_options);
  if (!printed.ok()) return absl::InternalError(std::string(printed.message()));
  std::fputs(json.c_str(), stdout);
  return absl::OkStatus();
}

std::string compactJson(const google::protobuf::Message& message) {
  std::string json;
  google::protobuf::util::JsonPrintOptions print_options;
  print_options.preserve_proto_field_names = true;
  VIEWLOOM_CHECK(google::protobuf::util::MessageToJsonString(message, &json, print_options).ok());
  return json;
}

}  // namespace viewloom::cli
