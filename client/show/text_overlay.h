// SPDX-License-Identifier: Apache-2.0
// Lines of text as a picture in a corner of the window.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "base/status.h"
#include "show/gl_texture.h"
#include "show/painter.h"
#include "text/font.h"

namespace viewloom::show {

// Thread-safety: main thread.
class TextOverlay {
 public:
  // The errors of Font::open.
  static absl::StatusOr<std::unique_ptr<TextOverlay>> make();

  // White on black, top left; lines end in a line feed. Not empty.
  absl::Status draw(const std::string& text, Painter& painter);

 private:
  explicit TextOverlay(std::unique_ptr<Font> font) : font_(std::move(font)) {}

  const std::unique_ptr<Font> font_;
  GlTexture texture_;
};

}  // namespace viewloom::show
