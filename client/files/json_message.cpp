// SPDX-License-Identifier: Apache-2.0
#include "files/json_message.h"

#include <google/protobuf/util/json_util.h>

#include <vector>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
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

absl::Status readJsonMessage(const std::filesystem::path& path, uint64_t bytes_max,
                             const std::string& what, google::protobuf::Message& message) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path, bytes_max);
  if (!bytes.ok()) return bytes.status();
  const auto parsed = google::protobuf::util::JsonStringToMessage(
      std::string(bytes->begin(), bytes->end()), &message);
  if (parsed.ok()) return absl::OkStatus();
  return refuseFile(path.string(), strCat("does not describe ", what,
                                          " in JSON: ", inOneLine(std::string(parsed.message()))));
}

}  // namespace viewloom::files
