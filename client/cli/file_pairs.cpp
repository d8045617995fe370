// SPDX-License-Identifier: Apache-2.0
#include "cli/file_pairs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/nearest_name.h"
#include "base/str_cat.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "photos/photo.h"

namespace viewloom::cli {
namespace {

using inputs::InputKind;

constexpr std::array<const char*, 3> kDepthWords{"disparity", "depth", "disp"};
constexpr std::array<const char*, 5> kColorWords{"colour", "color", "image", "beauty", "rgb"};

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// By its name alone: the file may be anything, or be gone by now.
bool isPicture(const std::string& file_name) {
  return !file_name.starts_with(".") &&
         files::containerOfName(file_name) != files::Container::kUnknown;
}

bool removeWord(std::string& text, const char* word) {
  const size_t at = text.find(word);
  if (at == std::string::npos) return false;
  text.erase(at, std::char_traits<char>::length(word));
  return true;
}

}  // namespace

PairKey pairKey(const std::string& file_name) {
  PairKey found{.key = lowered(std::filesystem::path(file_name).stem().string())};
  for (const char* word : kDepthWords) {
    if (!found.is_depth) found.is_depth = removeWord(found.key, word);
  }
  if (!found.is_depth) {
    for (const char* word : kColorWords) {
      if (removeWord(found.key, word)) break;
    }
  }
  std::erase_if(found.key, [](char c) { return c == '_' || c == '-' || c == '.' || c == ' '; });
  return found;
}

// Photos are one half of a pair if the kind of input has depth files.
absl::StatusOr<bool> FilePairs::isWholePhoto(const std::string& file) const {
  if (settings_.kind != InputKind::kAuto && settings_.kind != InputKind::kIphone) return false;
  const auto photo = photos::Photo::open(file);
  if (!photo.ok()) return photo.status();
  return photo->description().depth.has_value();
}

// Whether the file has colour and depth.
absl::StatusOr<bool> FilePairs::isWhole(const std::string& file) const {
  if (settings_.kind == InputKind::kRgbd || settings_.kind == InputKind::k2dPlusZ) return true;
  if (photos::isPhoto(file)) return isWholePhoto(file);
  if (!files::isExr(file)) return false;
  const auto how = inputs::interpret(settings_, {.color = file, .view = view_});
  if (!how.ok()) return how.status();
  const v1::LayerFiles& layer = how->source.layers(0);
  return !layer.color().channels().empty() && !layer.depth().channels().empty();
}

void FilePairs::giveUpOldest() {
  while (waiting_.size() > kWaitingMax) {
    const std::string oldest = std::exchange(waiting_.front(), {});
    waiting_.pop_front();
    const PairKey its = pairKey(oldest);
    Halves& list = its.is_depth ? depths_ : colors_;
    const auto entry = list.find(its.key);
    // Paired, or came again.
    if (entry == list.end() || entry->second.file != oldest) continue;
    list.erase(entry);
    given_up_.push_back(oldest);
  }
}

std::optional<FrameFiles> FilePairs::pairUp(const std::string& file_name,
                                            std::chrono::steady_clock::time_point now) {
  const PairKey own = pairKey(file_name);
  Halves& mine = own.is_depth ? depths_ : colors_;
  Halves& others = own.is_depth ? colors_ : depths_;
  const auto other = others.find(own.key);
  if (other == others.end()) {
    const auto earlier = mine.find(own.key);
    if (earlier != mine.end() && earlier->second.file != file_name) {
      notes_.push_back(strCat(earlier->second.file, " and ", file_name, " are both the ",
                              own.is_depth ? "depth" : "colour", " of one frame; the newest, ",
                              file_name, ", is used"));
    }
    mine[own.key] = {.file = file_name, .since = now};
    waiting_.push_back(file_name);
    giveUpOldest();
    return std::nullopt;
  }
  const std::string color = own.is_depth ? other->second.file : file_name;
  const std::string depth = own.is_depth ? file_name : other->second.file;
  others.erase(other);
  mine.erase(own.key);
  return FrameFiles{
      .manifest = {},
      .deep = {},
      .input = {
          .color = (folder_ / color).string(), .depth = (folder_ / depth).string(), .view = view_}};
}

std::string FilePairs::describe(const std::string& key, const Half& half, bool is_depth,
                                const Halves& others) {
  const std::filesystem::path name(half.file);
  std::string text =
      strCat(half.file, ": waiting for its ", is_depth ? "colour" : "depth", ", named ");
  text += is_depth ? "like frame.png for frame_depth.png"
                   : strCat("like ", name.stem().string(), "_depth", name.extension().string());
  std::vector<std::string> keys;
  for (const auto& [other_key, other] : others) keys.push_back(other_key);
  const std::string nearest = nearestName(key, keys);
  if (nearest.empty()) return text;
  return strCat(text, "; ", others.at(nearest).file,
                " is waiting too, but its name differs. Rename one of the two");
}

std::vector<std::string> FilePairs::takeNotes(std::chrono::steady_clock::time_point now) {
  const auto tell = [&](Halves& halves, bool is_depth, const Halves& others) {
    for (auto& [key, half] : halves) {
      if (half.is_told || now - half.since < kPatience) continue;
      half.is_told = true;
      notes_.push_back(describe(key, half, is_depth, others));
    }
  };
  tell(colors_, false, depths_);
  tell(depths_, true, colors_);
  return std::exchange(notes_, {});
}

absl::StatusOr<std::optional<FrameFiles>> FilePairs::add(
    const std::string& file_name, std::chrono::steady_clock::time_point now) {
  if (!isPicture(file_name)) return std::optional<FrameFiles>();
  const std::string file = (folder_ / file_name).string();
  if (files::isExr(file)) {
    const auto description = files::describeExr(file);
    if (!description.ok()) return description.status();
    if (description->isDeep()) {
      return std::optional(FrameFiles{.manifest = {}, .deep = file, .input = {}});
    }
  }
  const absl::StatusOr<bool> is_whole = isWhole(file);
  if (!is_whole.ok()) return is_whole.status();
  if (!*is_whole) return pairUp(file_name, now);
  return std::optional(
      FrameFiles{.manifest = {}, .deep = {}, .input = {.color = file, .view = view_}});
}

std::vector<std::string> FilePairs::takeGivenUp() {
  return std::exchange(given_up_, {});
}

}  // namespace viewloom::cli
