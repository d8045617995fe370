// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "base/check.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "lib/atlas_assembler.h"
#include "lib/color_decoder.h"

namespace viewloom {
namespace {

constexpr uint64_t kAtlasBytesMax = 1 << 20;
// Larger layouts are lawful, and take long to decode.
constexpr uint64_t kDecodedPxMax = 1 << 20;

void decodeAll(const Atlas& atlas, ColorDecoder& decoder) {
  const v1::AtlasLayout& layout = *atlas.layout;
  VIEWLOOM_CHECK(atlas.byteCount() <= kAtlasBytesMax);
  if (uint64_t{layout.size().width()} * layout.size().height() > kDecodedPxMax) return;
  (void)decoder.decode(atlas);
  for (int plane = 0; plane <= v1::AtlasPlane_MAX; ++plane) {
    const absl::StatusOr<AtlasPicture> picture =
        decodePlane(atlas, static_cast<v1::AtlasPlane>(plane));
    if (!picture.ok()) continue;
    VIEWLOOM_CHECK(picture->samples.size() ==
                   size_t{picture->width_px} * picture->height_px * picture->channels);
    if (layout.view_count() > 0) cutView(*picture, layout, layout.view_count() - 1);
  }
}

}  // namespace

bool fuzzAtlas(FuzzBytes bytes) {
  Script script(bytes);
  AtlasAssembler assembler(kAtlasBytesMax);
  ColorDecoder decoder;
  bool is_whole = false;
  while (!script.atEnd()) {
    const size_t message_bytes = script.take(2);
    const FuzzBytes wire = script.takeBytes(message_bytes);
    v1::StreamAtlasesResponse message;
    if (!message.ParseFromArray(wire.data(), static_cast<int>(wire.size()))) return is_whole;
    const absl::StatusOr<std::optional<Atlas>> atlas = assembler.add(std::move(message));
    if (!atlas.ok()) return is_whole;
    if (!atlas->has_value()) continue;
    decodeAll(**atlas, decoder);
    is_whole = true;
  }
  return is_whole;
}

}  // namespace viewloom
