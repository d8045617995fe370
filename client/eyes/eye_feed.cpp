// SPDX-License-Identifier: Apache-2.0
#include "eyes/eye_feed.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <utility>

#include <google/protobuf/util/json_util.h>
#include <nlohmann/json.hpp>

#include "base/json_nesting.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kLineBytesMax = 64 << 10;
constexpr int kTick_ms = 50;  // between two looks at whether to stop
constexpr double kPauseMax_s = 3600;

absl::Status readTime(const nlohmann::json& line, const char* key, int64_t& time_ns) {
  const auto found = line.find(key);
  if (found == line.end() || !found->is_number_integer()) {
    return invalidField(key, "missing or not a whole number; accepted is a time in nanoseconds");
  }
  time_ns = found->get<int64_t>();
  return absl::OkStatus();
}

absl::Status addEye(const nlohmann::json& line, const char* key, v1::EyePoses& poses) {
  const auto found = line.find(key);
  if (found != line.end() && found->is_object()) {
    const auto parsed =
        google::protobuf::util::JsonStringToMessage(found->dump(), poses.add_eyes());
    if (parsed.ok()) return absl::OkStatus();
    return invalidField(key, strCat("is no Camera: ", std::string(parsed.message())));
  }
  bool is_place = found != line.end() && found->is_array() && found->size() == 3;
  for (size_t i = 0; is_place && i < 3; ++i) is_place = (*found)[i].is_number();
  if (!is_place)
    return invalidField(key,
                        "missing or not a position; accepted is [x, y, z] in metres, "
                        "or a Camera");
  v1::Vector3& position = *poses.add_eyes()->mutable_pose()->mutable_position();
  position.set_x((*found)[0].get<double>());
  position.set_y((*found)[1].get<double>());
  position.set_z((*found)[2].get<double>());
  return absl::OkStatus();
}

int64_t nowNs() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string nameOf(const std::string& file) {
  return file == "-" ? "the eyes of the standard input" : "eyes of " + file;
}

bool isFile(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

absl::StatusOr<v1::EyePoses> parseEyePoses(const std::string& line) {
  if (isNestedDeeply(line)) {
    return absl::InvalidArgumentError(
        strCat("nests lists or objects deeper than ", kJsonDepthMax, " levels; accepted is less"));
  }
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object()) {
    return absl::InvalidArgumentError(
        "is not a JSON object; accepted is {\"time_ns\": 8, \"left\": [x, y, z], \"right\": [x, y, "
        "z]}");
  }
  v1::EyePoses poses;
  int64_t time_ns = 0;
  VIEWLOOM_RETURN_IF_ERROR(readTime(json, "time_ns", time_ns));
  poses.set_time_ns(time_ns);
  if (json.contains("predicted_display_time_ns")) {
    VIEWLOOM_RETURN_IF_ERROR(readTime(json, "predicted_display_time_ns", time_ns));
    poses.set_predicted_display_time_ns(time_ns);
  }
  VIEWLOOM_RETURN_IF_ERROR(addEye(json, "left", poses));
  VIEWLOOM_RETURN_IF_ERROR(addEye(json, "right", poses));
  return poses;
}

absl::StatusOr<std::unique_ptr<EyeFeed>> EyeFeed::open(const std::string& file) {
  const int descriptor =
      file == "-" ? dup(STDIN_FILENO) : ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    return absl::InvalidArgumentError(
        strCat(nameOf(file), ": cannot be read: ", std::strerror(errno)));
  }
  return std::unique_ptr<EyeFeed>(new EyeFeed(file, descriptor));
}

EyeFeed::EyeFeed(std::string file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor), has_own_times_(isFile(descriptor)) {}

EyeFeed::~EyeFeed() {
  thread_ = {};  // reads no more
  close(descriptor_);
}

void EyeFeed::start(EyeFeedCallbacks callbacks) {
  callbacks_ = std::move(callbacks);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void EyeFeed::run(const std::stop_token& stop) {
  while (true) {
    absl::StatusOr<std::optional<std::string>> line = nextLine(stop);
    if (line.ok() && !line->has_value()) return;
    absl::Status problem = line.status();
    if (line.ok()) {
      const absl::StatusOr<v1::EyePoses> poses = parseEyePoses(**line);
      problem = poses.status();
      if (poses.ok()) {
        if (has_own_times_) waitUntilDue(poses->time_ns(), stop);
        if (stop.stop_requested()) return;
        callbacks_.send(*poses);
        continue;
      }
    }
    callbacks_.on_failure(absl::InvalidArgumentError(
        strCat(nameOf(file_), ", line ", line_number_, ": ", std::string(problem.message()))));
    return;
  }
}

// Empty at the end, and when it shall stop.
absl::StatusOr<std::optional<std::string>> EyeFeed::nextLine(const std::stop_token& stop) {
  bool has_ended = false;
  while (!stop.stop_requested()) {
    const size_t end = unread_.find('\n');
    if (end != std::string::npos || (has_ended && !unread_.empty())) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end == std::string::npos ? end : end + 1);
      ++line_number_;
      if (line.find_first_not_of(" \t\r") != std::string::npos) return line;
      continue;
    }
    if (has_ended) return std::nullopt;
    if (unread_.size() > kLineBytesMax) {
      ++line_number_;
      return absl::InvalidArgumentError(
          strCat("is longer than ", kLineBytesMax, " bytes; accepted is one pose per line"));
    }
    pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
    if (poll(&ready, 1, kTick_ms) <= 0) continue;
    std::array<char, 4096> bytes;
    const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count < 0) {
      return absl::InvalidArgumentError(strCat("cannot be read: ", std::strerror(errno)));
    }
    if (count == 0)
      has_ended = true;
    else
      unread_.append(bytes.data(), size_t(count));
  }
  return std::nullopt;
}

void EyeFeed::waitUntilDue(int64_t time_ns, const std::stop_token& stop) {
  if (!first_) first_ = {.file_ns = time_ns, .here_ns = nowNs()};
  // Floating point, because a file may hold any whole number.
  const double due_s = (double(time_ns) - double(first_->file_ns)) * 1e-9;
  const double passed_s = double(nowNs() - first_->here_ns) * 1e-9;
  const double pause_s = std::min(due_s - passed_s, kPauseMax_s);
  if (pause_s <= 0) return;
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_for(lock, stop, std::chrono::nanoseconds(int64_t(pause_s * 1e9)),
                   [] { return false; });
}

}  // namespace viewloom
