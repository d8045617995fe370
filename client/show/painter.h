// SPDX-License-Identifier: Apache-2.0
// Draws pictures into the window: woven for a panel, placed as they are, or lines of text.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "base/status.h"
#include "calibration/calibration.h"
#include "frame/size.h"
#include "show/gl_program.h"
#include "show/gl_texture.h"
#include "text/font.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::show {

// px from the left and from the top.
struct PixelArea {
  double left_px = 0;
  double top_px = 0;
  double width_px = 0;
  double height_px = 0;
};

// The largest area of an aspect (width / height) in the middle of another, on whole px.
PixelArea fitInto(const PixelArea& area, double aspect);

// Thread-safety: main thread, with the context that it was made in.
class Painter {
 public:
  static absl::StatusOr<std::unique_ptr<Painter>> make(bool is_gles);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  // A black window of this size; what is drawn next goes into it.
  void begin(SizePx window_px);
  // From the window's top left corner; where views are blended, the two nearest of each subpixel.
  void weave(const GlTexture& atlas, const v1::AtlasLayout& layout, const Calibration& calibration,
             bool is_blended);
  // Part of a picture; px by px where source and target are of one size, which then lie on whole
  // px.
  void place(const GlTexture& picture, const PixelArea& source, const PixelArea& target);
  // The pattern of shaders/show/tune.frag.
  void tune(const Calibration& calibration);

 private:
  Painter(GlProgram weave, GlProgram place, GlProgram tune);
  void useLenses(const GlProgram& program, const Calibration& calibration) const;

  GlProgram weave_;
  GlProgram place_;
  GlProgram tune_;
  uint32_t vertices_ = 0;  // none, but OpenGL 3.3 wants an array of them
  SizePx window_px_;
};

// Lines of text as a picture in a corner of the window. Thread-safety: main thread.
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
