// SPDX-License-Identifier: Apache-2.0
#include "bridge/bridge.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/str_cat.h"
#include "bridge/json_answer.h"

namespace viewloom::bridge {
namespace {

using nlohmann::json;

constexpr const char* kOrchestration = "default";
constexpr const char* kNotABridge = "; check that --bridge names Looking Glass Bridge";
constexpr size_t kQuotedBytesMax = 60;
// Bridge shows an entry so long, then the next; a list that loops shows its only one for ever.
constexpr int kEntryDuration_ms = 20'000;
constexpr std::chrono::milliseconds kLastCall{300};  // to leave, once the caller has given up

// Bridge wraps values as {"name": ..., "type": ..., "value": VALUE}.
json unwrapped(const json& wrapped) {
  const bool is_wrapped = wrapped.is_object() && wrapped.contains("value");
  return is_wrapped ? wrapped["value"] : wrapped;
}

json member(const json& object, const char* name) {
  return object.is_object() && object.contains(name) ? unwrapped(object[name]) : json();
}

// The first of two spellings that is a number above zero; 0 = neither.
double number(const json& object, const char* name, const char* other_name) {
  for (const char* spelling : {name, other_name}) {
    const json value = member(object, spelling);
    if (value.is_number() && value.get<double>() > 0) return value.get<double>();
  }
  return 0;
}

// {"quiltX": 3360, "quiltY": 3360, "tileX": 8, "tileY": 6, "quiltAspect": 0.75}, or in the words of
// another version; a text of JSON.
std::optional<QuiltShape> readQuiltShape(const json& text) {
  if (!text.is_string()) return std::nullopt;
  const json quilt = parseAnswer(text.get<std::string>());
  constexpr double kCountMax = 65536;
  const double width_px = number(quilt, "quiltX", "quiltWidth");
  const double height_px = number(quilt, "quiltY", "quiltHeight");
  const double columns = number(quilt, "tileX", "columns");
  const double rows = number(quilt, "tileY", "rows");
  const double aspect = number(quilt, "quiltAspect", "renderAspect");
  for (const double count : {width_px, height_px, columns, rows}) {
    if (count < 1 || count > kCountMax) return std::nullopt;
  }
  if (aspect <= 0) return std::nullopt;
  return QuiltShape{.columns = static_cast<uint32_t>(columns),
                    .rows = static_cast<uint32_t>(rows),
                    .width_px = static_cast<uint32_t>(width_px),
                    .height_px = static_cast<uint32_t>(height_px),
                    .aspect = aspect};
}

// Ordinary monitors are listed as well, without a calibration.
std::optional<BridgeDisplay> readDisplay(const json& entry) {
  const json display = unwrapped(entry);
  const json index = member(display, "index");
  const json calibration = member(display, "calibration");
  const json hardware_id = member(display, "hwid");
  const bool is_calibrated = calibration.is_string() && !calibration.get<std::string>().empty();
  if (!index.is_number_integer() || !is_calibrated) return std::nullopt;
  return BridgeDisplay{
      .index = index.get<int>(),
      .name = hardware_id.is_string() ? hardware_id.get<std::string>() : "a display without a name",
      .default_quilt = readQuiltShape(member(display, "defaultQuilt"))};
}

std::string quoted(const std::string& text) {
  std::string shown = text.substr(0, kQuotedBytesMax);
  for (char& character : shown) {
    if (static_cast<unsigned char>(character) < ' ') character = ' ';
  }
  return strCat("\"", shown, text.size() > kQuotedBytesMax ? "...\"" : "\"");
}

}  // namespace

Bridge::Bridge(HttpAddress address, Patience patience)
    : address_(std::move(address)), patience_(std::move(patience)) {}

Bridge::~Bridge() {
  // A Bridge that does not answer has nothing to be left.
  if (orchestration_.empty()) return;
  Patience patience = patience_;
  const bool has_given_up = patience.has_given_up && patience.has_given_up();
  if (has_given_up) patience = {.timeout = std::min(patience.timeout, kLastCall)};
  (void)call("exit_orchestration", json::object(), patience);
}

std::string Bridge::asked(const std::string& endpoint) const {
  return strCat("Bridge at ", address_.url(), ", asked for ", endpoint, ", ");
}

absl::StatusOr<json> Bridge::call(const std::string& endpoint, json arguments,
                                  const Patience& patience) {
  if (!orchestration_.empty()) arguments["orchestration"] = orchestration_;
  const absl::StatusOr<HttpResponse> response = exchange(
      address_, {.method = "PUT", .target = "/" + endpoint, .json = arguments.dump()}, patience);
  const std::string reason(response.status().message());
  if (absl::IsCancelled(response.status())) return response.status();
  if (absl::IsUnavailable(response.status())) {
    return absl::UnavailableError(
        strCat("no Bridge at ", address_.url(), " (", reason,
               "); start Looking Glass Bridge on the display's machine, or name another "
               "with --bridge http://HOST:PORT"));
  }
  if (absl::IsDeadlineExceeded(response.status())) {
    return absl::DeadlineExceededError(
        strCat(asked(endpoint), "gave no answer within ", patience.timeout.count(),
               " ms; start Bridge again, or wait longer with --timeout SECONDS"));
  }
  if (!response.ok()) {
    return absl::FailedPreconditionError(
        strCat(asked(endpoint), "answered no HTTP (", reason, ")", kNotABridge));
  }
  if (!response->isOk()) {
    return absl::FailedPreconditionError(
        strCat(asked(endpoint), "answered with HTTP status ", response->status, kNotABridge));
  }
  if (response->body.empty()) {
    return absl::FailedPreconditionError(
        strCat(asked(endpoint),
               "answered with an empty body, as to all it does not know; update Looking "
               "Glass Bridge"));
  }
  const json answer = parseAnswer(response->body);
  if (!answer.is_object()) {
    return absl::FailedPreconditionError(strCat(asked(endpoint), "answered ",
                                                quoted(response->body),
                                                " and not the JSON "
                                                "of a Bridge",
                                                kNotABridge));
  }
  const json status = member(answer, "status");
  if (!status.is_string() || status.get<std::string>() != "Completion") {
    return absl::FailedPreconditionError(
        strCat(asked(endpoint), "ended with status ", quoted(status.dump()),
               " instead of Completion; start Bridge again and retry"));
  }
  return member(answer, "payload");
}

absl::Status Bridge::checkedCall(const std::string& endpoint, const json& arguments) {
  return call(endpoint, arguments, patience_).status();
}

absl::Status Bridge::enter() {
  const absl::StatusOr<json> token =
      call("enter_orchestration", {{"name", kOrchestration}}, patience_);
  VIEWLOOM_RETURN_IF_ERROR(token.status());
  if (!token->is_string() || token->get<std::string>().empty()) {
    return absl::FailedPreconditionError(strCat(
        asked("enter_orchestration"), "answered without a token; update Looking Glass Bridge"));
  }
  orchestration_ = token->get<std::string>();
  return absl::OkStatus();
}

absl::StatusOr<std::vector<BridgeDisplay>> Bridge::displays() {
  const absl::StatusOr<json> listed = call("available_output_devices", json::object(), patience_);
  VIEWLOOM_RETURN_IF_ERROR(listed.status());
  std::vector<BridgeDisplay> displays;
  if (listed->is_structured()) {
    for (const json& entry : *listed) {
      if (auto display = readDisplay(entry)) displays.push_back(*std::move(display));
    }
  }
  if (!displays.empty()) return displays;
  return absl::FailedPreconditionError(
      strCat("Bridge at ", address_.url(),
             " has no light-field display; connect its USB and its video cable, and see "
             "that Bridge shows it"));
}

absl::Status Bridge::play(const AddressedQuilt& quilt, int display_index) {
  const std::string playlist = play_count_++ % 2 == 0 ? "viewloom_a" : "viewloom_b";
  VIEWLOOM_RETURN_IF_ERROR(
      checkedCall("show_window", {{"show_window", true}, {"head_index", display_index}}));
  VIEWLOOM_RETURN_IF_ERROR(checkedCall("instance_playlist", {{"name", playlist}, {"loop", true}}));
  VIEWLOOM_RETURN_IF_ERROR(checkedCall("insert_playlist_entry", {{"name", playlist},
                                                                 {"index", 0},
                                                                 {"uri", quilt.uri},
                                                                 {"rows", quilt.rows},
                                                                 {"cols", quilt.columns},
                                                                 {"aspect", quilt.aspect},
                                                                 {"view_count", quilt.view_count},
                                                                 {"durationMS", kEntryDuration_ms},
                                                                 {"isRGBD", 0},
                                                                 {"tag", "viewloom"}}));
  return checkedCall("play_playlist", {{"name", playlist}, {"head_index", display_index}});
}

}  // namespace viewloom::bridge
