// SPDX-License-Identifier: Apache-2.0
#include "offline/compare_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/str_cat.h"
#include "encode/encoded_band.h"
#include "files/frame_manifest.h"
#include "scoring/inner_part.h"

namespace viewloom {
namespace {

using Json = nlohmann::ordered_json;

absl::Status checkShape(const v1::TruthView& view, const ScoredImage& truth,
                        const RenderedAtlas& atlas, uint32_t border_px) {
  const SizePx tile_px = atlas.layout->tile_size_px;
  if (truth.size_px != tile_px) {
    return invalidField(
        "color.file",
        strCat(view.color().file(), " is ", truth.size_px.width, "x", truth.size_px.height,
               " px; accepted is the size of the view, ", tile_px.width, "x", tile_px.height));
  }
  if (2 * uint64_t{border_px} >= std::min(tile_px.width, tile_px.height)) {
    return invalidField("--border", strCat("got ", border_px, ", which leaves nothing of ",
                                           tile_px.width, "x", tile_px.height, " px"));
  }
  return absl::OkStatus();
}

absl::StatusOr<Json> compareView(const v1::TruthView& view, const RenderedAtlas& atlas,
                                 const CompareOptions& options,
                                 const std::filesystem::path* covered_mask) {
  if (view.view_index() >= atlas.layout->views.size()) {
    return invalidField("view_index", strCat("got ", view.view_index(), ", accepted is 0..",
                                             atlas.layout->views.size() - 1));
  }
  const auto truth = loadScoredImage(view.color(), options.truth.parent_path(), options.transfer);
  if (!truth.ok()) return withFieldPrefix(truth.status(), "color");
  VIEWLOOM_RETURN_IF_ERROR(checkShape(view, *truth, atlas, options.border_px));

  const RenderedView rendered = cutView(atlas, view.view_index(), options.transfer);
  const InnerPart inner = {options.border_px, truth->size_px};
  const ImageComparison comparison(cropped(rendered.image, inner), cropped(*truth, inner),
                                   options.transfer);
  Json json;
  json["view"] = view.view_index();
  json["by_renderer"] = scoreJson(scoreByClass(comparison, cropped(rendered.classes, inner)));
  if (covered_mask != nullptr) {
    const auto given = loadCoveredMask(*covered_mask, truth->size_px);
    if (!given.ok()) return given.status();
    json["by_mask"] = scoreJson(scoreByClass(comparison, cropped(*given, inner)));
  }
  return json;
}

Json classJson(const ImageScore& score) {
  Json json;
  json["pixels"] = score.pixel_count;
  json["share"] = score.share;
  if (score.pixel_count == 0) {
    json["psnr_db"] = nullptr;
    json["ssim"] = nullptr;
    json["flip"] = nullptr;
  } else {
    json["psnr_db"] = std::isinf(score.psnr_db) ? Json("inf") : Json(score.psnr_db);
    json["ssim"] = score.ssim;
    json["flip"] = score.flip;
  }
  return json;
}

PixelClass classOf(uint8_t ray_class) {
  switch (static_cast<RayClass>(ray_class)) {
    case RayClass::kHidden:
      return PixelClass::kHidden;
    case RayClass::kOutside:
      return PixelClass::kOutside;
    default:
      return PixelClass::kCovered;
  }
}

}  // namespace

absl::StatusOr<Json> compareViews(const RenderedAtlas& atlas, const CompareOptions& options) {
  const auto truth = files::readTruthManifest(options.truth);
  if (!truth.ok()) return truth.status();
  const size_t view_count = static_cast<size_t>(truth->views_size());
  if (!options.covered_masks.empty() && options.covered_masks.size() != view_count) {
    return invalidField("--covered-mask",
                        strCat("got ", options.covered_masks.size(), " masks for ", view_count,
                               " true views; accepted is one each, or none"));
  }
  Json views = Json::array();
  for (size_t i = 0; i < view_count; ++i) {
    const bool has_mask = !options.covered_masks.empty();
    auto view = compareView(truth->views(int(i)), atlas, options,
                            has_mask ? &options.covered_masks[i] : nullptr);
    if (!view.ok()) return withFieldPrefix(view.status(), strCat("views[", i, "]"));
    views.push_back(*std::move(view));
  }
  return views;
}

Json scoreJson(const ClassScores& scores) {
  return {{"covered", classJson(scores.covered)},
          {"hidden", classJson(scores.hidden)},
          {"outside", classJson(scores.outside)},
          {"all", classJson(scores.all)}};
}

RenderedView cutView(const RenderedAtlas& atlas, uint32_t view, ScoreTransfer transfer) {
  const AtlasLayout& layout = *atlas.layout;
  const TileOrigin origin = layout.tileOrigin(view);
  RenderedView cut = {.image = {.size_px = layout.tile_size_px, .rgb = {}}, .classes = {}};
  cut.image.rgb.reserve(3 * layout.tile_size_px.area());
  cut.classes.reserve(layout.tile_size_px.area());
  for (size_t y = 0; y < layout.tile_size_px.height; ++y) {
    for (size_t x = 0; x < layout.tile_size_px.width; ++x) {
      const size_t i = (origin.y_px + y) * layout.size_px.width + origin.x_px + x;
      for (size_t c = 0; c < 3; ++c) {
        cut.image.rgb.push_back(scoredSample(atlas.linear[4 * i + c], transfer));
      }
      cut.classes.push_back(classOf(atlas.mask[i]));
    }
  }
  return cut;
}

}  // namespace viewloom
