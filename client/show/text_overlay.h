// SPDX-License-Identifier: Apache-2.0
// Lines of text as a picture in a corner of the window.
#pragma once

#include <memory>
#include <string>

#include "base/status.h"
#include "show/gl_texture.h"
#include "show/painter.h"

struct _TTF_Font;  // NOLINT(bugprone-reserved-identifier): SDL_ttf's name

namespace viewloom::show {

// Thread-safety: main thread.
class TextOverlay {
 public:
  // FAILED_PRECONDITION when the font is not installed.
  static absl::StatusOr<std::unique_ptr<TextOverlay>> make();
  ~TextOverlay();
  TextOverlay(const TextOverlay&) = delete;
  TextOverlay& operator=(const TextOverlay&) = delete;

  // White on black, top left; lines end in a line feed. Not empty.
  absl::Status draw(const std::string& text, Painter& painter);

 private:
  explicit TextOverlay(_TTF_Font* font) : font_(font) {}

  _TTF_Font* font_;
  GlTexture texture_;
};

}  // namespace viewloom::show
