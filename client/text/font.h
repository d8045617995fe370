// SPDX-License-Identifier: Apache-2.0
// Text as a picture: the share of each px that letters cover.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

struct _TTF_Font;  // NOLINT(bugprone-reserved-identifier): SDL_ttf's name

namespace viewloom {

struct WrittenText {
  SizePx size_px;
  std::vector<uint8_t> coverage;  // uint8_t[height][width], 255 = all of it; top row first
};

// Letters of one width. Thread-safety: none; one thread at a time for all fonts.
class Font {
 public:
  // em_px: the size of the font; letters are 0.6 of it wide. FAILED_PRECONDITION when the font is
  // not installed.
  static absl::StatusOr<std::unique_ptr<Font>> open(int em_px);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  // UTF-8, not empty; lines end in a line feed.
  absl::StatusOr<WrittenText> write(const std::string& text) const;

 private:
  explicit Font(_TTF_Font* font) : font_(font) {}

  _TTF_Font* font_;
};

// Letters of every size that somebody asks for. Thread-safety: as Font.
class Lettering {
 public:
  // An empty picture where it cannot be written; status() says why.
  WrittenText write(double em_px, const std::string& text);
  // The first problem there was.
  const absl::Status& status() const { return status_; }

 private:
  std::map<int, std::unique_ptr<Font>> fonts_;  // by their size, px
  absl::Status status_;
};

}  // namespace viewloom
