// SPDX-License-Identifier: Apache-2.0
#include "cli/file_pairs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "files/exr_description.h"
#include "files/exr_image.h"
#include "photos/photo.h"

namespace viewloom::cli {
namespace {

using inputs::InputKind;

constexpr std::array<const char*, 9> kPictures{".exr", ".png",  ".jpg",  ".jpeg", ".pfm",
                                               ".yuv", ".heic", ".heif", ".hif"};
constexpr std::array<const char*, 3> kDepthWords{"disparity", "depth", "disp"};
constexpr std::array<const char*, 5> kColorWords{"colour", "color", "image", "beauty", "rgb"};

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool isPicture(const std::string& file_name) {
  const std::string extension = lowered(std::filesystem::path(file_name).extension().string());
  return !file_name.starts_with(".") &&
         std::find(kPictures.begin(), kPictures.end(), extension) != kPictures.end();
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

// What a kind of input says of depth files makes photos one half of a pair.
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
  if (!isExr(file)) return false;
  const auto how = inputs::interpret(settings_, {.color = file, .view = view_});
  if (!how.ok()) return how.status();
  const v1::LayerFiles& layer = how->source.layers(0);
  if (!layer.depth().channels().empty()) return true;
  const auto usual = files::exrChannelsOfView(file, view_);
  if (!usual.ok()) return usual.status();
  return !usual->color.empty() && !usual->depth.empty();
}

std::optional<FrameFiles> FilePairs::pairUp(const std::string& file_name) {
  const PairKey own = pairKey(file_name);
  auto& mine = own.is_depth ? depths_ : colors_;
  auto& others = own.is_depth ? colors_ : depths_;
  const auto other = others.find(own.key);
  if (other == others.end()) {
    mine[own.key] = file_name;
    waiting_.push_back(file_name);
    while (waiting_.size() > kWaitingMax) {
      const std::string oldest = std::exchange(waiting_.front(), {});
      waiting_.pop_front();
      const PairKey its = pairKey(oldest);
      auto& list = its.is_depth ? depths_ : colors_;
      const auto entry = list.find(its.key);
      if (entry == list.end() || entry->second != oldest) continue;  // paired, or came again
      list.erase(entry);
      given_up_.push_back(oldest);
    }
    return std::nullopt;
  }
  const std::string color = own.is_depth ? other->second : file_name;
  const std::string depth = own.is_depth ? file_name : other->second;
  others.erase(other);
  mine.erase(own.key);
  return FrameFiles{
      .manifest = {},
      .deep = {},
      .input = {
          .color = (folder_ / color).string(), .depth = (folder_ / depth).string(), .view = view_}};
}

absl::StatusOr<std::optional<FrameFiles>> FilePairs::add(const std::string& file_name) {
  if (!isPicture(file_name)) return std::optional<FrameFiles>();
  const std::string file = (folder_ / file_name).string();
  if (isExr(file)) {
    const auto description = files::describeExr(file);
    if (!description.ok()) return description.status();
    if (description->isDeep()) {
      return std::optional(FrameFiles{.manifest = {}, .deep = file, .input = {}});
    }
  }
  const absl::StatusOr<bool> is_whole = isWhole(file);
  if (!is_whole.ok()) return is_whole.status();
  if (!*is_whole) return pairUp(file_name);
  return std::optional(
      FrameFiles{.manifest = {}, .deep = {}, .input = {.color = file, .view = view_}});
}

std::vector<std::string> FilePairs::takeGivenUp() {
  return std::exchange(given_up_, {});
}

}  // namespace viewloom::cli
