// SPDX-License-Identifier: Apache-2.0
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>

#include <string>
#include <vector>

#include "absl/strings/str_split.h"
#include "access/access_control.h"
#include "base/check.h"
#include "base/clock.h"
#include "calibration/calibration.h"
#include "calibration/make_lenticular.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "messages/display_from_proto.h"
#include "messages/message_from_json.h"
#include "viewloom/v1/web_socket.pb.h"
#include "web/asked_display.h"
#include "web/host_policy.h"
#include "web/quilt_address.h"
#include "web/url.h"
#include "web/watch_request.h"

namespace viewloom {
namespace {

constexpr size_t kJsonBytesMax = 128 << 10;

// A server with the stream "s", and a caller who may watch it.
class OneStream {
 public:
  OneStream()
      : claim_(*directory_.claim("s", "", [] {})), caller_(*access_.admit(kWebSocket, "", "")) {}
  absl::Status check(const std::string& name) const {
    return checkStream(name, caller_, directory_);
  }

 private:
  ManualClock clock_;
  AccessControl access_{clock_};
  StreamDirectory directory_{clock_, 4};
  const std::unique_ptr<StreamDirectory::Claim> claim_;
  const Caller caller_;
};

bool isTaken(const absl::Status& status) {
  VIEWLOOM_CHECK(status.ok() || !status.message().empty());
  return status.ok();
}

bool isServed(const absl::StatusOr<WatchRequest>& request) {
  static const OneStream stream;
  return isTaken(request.status()) && isTaken(stream.check(request->stream));
}

// A text of JSON is read as the message that it was written from, but for the sign of a zero, which
// protobuf writes and does not read.
void checkRoundTrip(const google::protobuf::Message& message, google::protobuf::Message& again) {
  std::string json;
  VIEWLOOM_CHECK(google::protobuf::util::MessageToJsonString(message, &json).ok());
  VIEWLOOM_CHECK(messageFromJson(json, json.size(), again).ok());
  VIEWLOOM_CHECK(google::protobuf::util::MessageDifferencer::Equivalent(again, message));
}

std::vector<std::string> linesOf(FuzzBytes bytes) {
  return absl::StrSplit(std::string(asText(bytes)), '\n');
}

std::string lineAt(const std::vector<std::string>& lines, size_t index) {
  return index < lines.size() ? lines[index] : "";
}

// Reads a message of a client, like Viewer.
bool takeMessage(const std::string& text, AskedDisplay& asked) {
  v1::ViewerMessage message;
  if (!isTaken(messageFromJson(text, kJsonBytesMax, message))) return false;
  if (!message.has_change()) {
    return message.message_case() != v1::ViewerMessage::MESSAGE_NOT_SET;
  }
  AskedDisplay changed = asked;
  if (message.change().has_display()) changed.display = message.change().display();
  if (message.change().has_encoding()) changed.encoding = message.change().encoding();
  if (!isServed(makeWatchRequest(changed))) return false;
  asked = changed;
  return true;
}

// Reads a URL, like the routes of the server.
bool asksForPicture(const Url& url) {
  const QuiltAddressForm form{.root = "/still/", .extensions = {".jpg"}};
  if (url.path.starts_with(form.root)) {
    const absl::StatusOr<QuiltAddress> address = parseQuiltAddress(url, form);
    return isTaken(address.status()) && isServed(address->request);
  }
  return isServed(makeWatchRequest(url.parameters));
}

}  // namespace

bool fuzzDisplayJson(FuzzBytes bytes) {
  v1::Display display;
  if (!isTaken(messageFromJson(asText(bytes), kJsonBytesMax, display))) return false;
  v1::Display again;
  checkRoundTrip(display, again);
  return isTaken(displayFromProto(display).status());
}

bool fuzzCalibration(FuzzBytes bytes) {
  const absl::StatusOr<Calibration> read = parseCalibration(asText(bytes));
  if (!isTaken(read.status())) return false;
  makeLenticular(*read);
  const absl::StatusOr<Calibration> again = parseCalibration(writeCalibration(*read));
  VIEWLOOM_CHECK(again.ok() && *again == *read);
  return true;
}

bool fuzzViewer(FuzzBytes bytes) {
  AskedDisplay asked{.stream = "s", .display = {}, .encoding = {}};
  size_t taken_count = 0;
  for (const std::string& line : linesOf(bytes)) taken_count += takeMessage(line, asked);
  return taken_count > 0;
}

bool fuzzHttp(FuzzBytes bytes) {
  const std::vector<std::string> lines = linesOf(bytes);
  const HostPolicy policy({"render7"}, {"proxy.example"}, {"https://show.example"});
  bool is_accepted = isTaken(policy.checkHost(lineAt(lines, 1)));
  const PageHeaders page{.origin = lineAt(lines, 2)};
  is_accepted &=
      isTaken(policy.checkWebSocket(page, lineAt(lines, 1))) && isTaken(policy.checkPage(page));
  const absl::StatusOr<Url> url = parseUrl(lineAt(lines, 0));
  if (!isTaken(url.status())) return false;
  VIEWLOOM_CHECK(url->path.starts_with('/'));
  const absl::StatusOr<Url> again = parseUrl("/?" + queryString(url->parameters));
  VIEWLOOM_CHECK(again.ok() && again->parameters == url->parameters);
  return is_accepted && asksForPicture(*url);
}

}  // namespace viewloom
