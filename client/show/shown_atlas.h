// SPDX-License-Identifier: Apache-2.0
// The atlas on the screen: its picture on the graphics card, and how each mode draws it.
#pragma once

#include <memory>
#include <optional>

#include "base/status.h"
#include "calibration/calibration.h"
#include "lib/atlas.h"
#include "lib/color_decoder.h"
#include "show/gl_texture.h"
#include "show/painter.h"
#include "show/show_settings.h"

namespace viewloom::show {

// An atlas as it comes from the network, decoded.
struct DecodedAtlas {
  AtlasPicture picture;
  std::shared_ptr<const v1::AtlasLayout> layout;
  v1::AtlasHeader header;
};

// DATA_LOSS when its bytes do not decode, or the layout does not hold its own tiles.
absl::StatusOr<DecodedAtlas> decodeAtlas(const Atlas& atlas, ColorDecoder& decoder);

// Thread-safety: main thread.
class ShownAtlas {
 public:
  // RESOURCE_EXHAUSTED when the graphics card does not take its picture.
  absl::Status replace(const DecodedAtlas& atlas);
  bool isThere() const { return layout_ != nullptr; }
  // Layout of the atlas on the screen; an empty one before the first.
  const v1::AtlasLayout& layout() const;
  const v1::AtlasHeader& header() const { return header_; }
  // Draws it as the mode says. What the server interlaced for the panel is never woven again, and a
  // quilt that still shows while the mode is kNative is woven.
  void draw(const ShowSettings& settings, const std::optional<Calibration>& calibration,
            SizePx window_px, Painter& painter) const;

 private:
  void drawViews(const ShowSettings& settings, SizePx window_px, Painter& painter) const;

  GlTexture texture_;
  std::shared_ptr<const v1::AtlasLayout> layout_;
  v1::AtlasHeader header_;
};

}  // namespace viewloom::show
