// SPDX-License-Identifier: Apache-2.0
#include "files/json_message.h"

#include <string_view>
#include <vector>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "messages/message_from_json.h"

namespace viewloom::files {

absl::Status readJsonMessage(const std::filesystem::path& path, uint64_t bytes_max,
                             const std::string& what, google::protobuf::Message& message) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path, bytes_max);
  if (!bytes.ok()) return bytes.status();
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const absl::Status parsed = messageFromJson(text, bytes_max, message);
  if (parsed.ok()) return absl::OkStatus();
  return refuseFile(path.string(), strCat("does not describe ", what,
                                          " in JSON: ", std::string(parsed.message())));
}

}  // namespace viewloom::files
