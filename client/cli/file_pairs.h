// SPDX-License-Identifier: Apache-2.0
// Finds which files of a folder make a frame: alone, or as a pair of colour and depth.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/frame_loader.h"

namespace viewloom::cli {

// By its name: small letters, without separators, and without the words that tell colour (color,
// colour, rgb, image, beauty) from depth (depth, disparity, disp). A pair has equal keys:
// frame_0001.png and frame_0001_depth.png, Image0001.exr and Depth0001.exr, rgb-7.jpg and
// depth-7.png.
struct PairKey {
  std::string key;
  bool is_depth = false;
};
PairKey pairKey(const std::string& file_name);

// Thread-safety: none; one owner.
class FilePairs {
 public:
  FilePairs(std::filesystem::path folder, inputs::InputSettings settings, std::string view)
      : folder_(std::move(folder)), settings_(std::move(settings)), view_(std::move(view)) {}

  // The frame that a complete file makes, alone or with its other half that came before. Nothing
  // for halves without the other, and for files that are no pictures. Errors name the file: it is
  // broken.
  absl::StatusOr<std::optional<FrameFiles>> add(
      const std::string& file_name,
      std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now());

  // A line for each half that has waited for kPatience, once: its name, what its other half would
  // be named, and the waiting file that is nearly named so. Also one where two files are the same
  // half of one frame.
  std::vector<std::string> takeNotes(std::chrono::steady_clock::time_point now);

  // Files that waited for their other half too long: more than kWaitingMax others did.
  std::vector<std::string> takeGivenUp();

  static constexpr size_t kWaitingMax = 256;
  static constexpr std::chrono::seconds kPatience{5};

 private:
  absl::StatusOr<bool> isWhole(const std::string& file) const;
  absl::StatusOr<bool> isWholePhoto(const std::string& file) const;
  struct Half {
    std::string file;
    std::chrono::steady_clock::time_point since;
    bool is_told = false;
  };
  using Halves = std::map<std::string, Half>;  // by key

  std::optional<FrameFiles> pairUp(const std::string& file_name,
                                   std::chrono::steady_clock::time_point now);
  void giveUpOldest();
  static std::string describe(const std::string& key, const Half& half, bool is_depth,
                              const Halves& others);

  const std::filesystem::path folder_;
  const inputs::InputSettings settings_;
  const std::string view_;
  Halves colors_;  // waiting
  Halves depths_;
  std::deque<std::string> waiting_;  // names, the oldest first; some may be paired since
  std::vector<std::string> given_up_;
  std::vector<std::string> notes_;
};

}  // namespace viewloom::cli
