// SPDX-License-Identifier: Apache-2.0
// Cameras in the world as one display of a frame.
#pragma once

#include <optional>
#include <vector>

#include "walk/offline_renderer.h"

namespace viewloom {

// One source, twice: several sources have kernels of their own.
FramePtr twice(const Frame& one);

// Views of this size, traced so many times finer: colour before it is rounded, and classes.
RenderedAtlas renderInWorld(OfflineRenderer& renderer, const Frame& frame,
                            const std::vector<Camera>& views, SizePx view_px, size_t fineness,
                            const std::optional<ReflectionSpec>& reflection = std::nullopt);

}  // namespace viewloom
