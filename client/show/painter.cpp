// SPDX-License-Identifier: Apache-2.0
#include "show/painter.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "calibration/make_lenticular.h"
#include "show/shader_texts.h"

namespace viewloom::show {
namespace {

std::array<float, 2> sizeAsFloats(SizePx size_px) {
  return {static_cast<float>(size_px.width), static_cast<float>(size_px.height)};
}

std::array<float, 4> areaAsFloats(const PixelArea& area) {
  return {static_cast<float>(area.left_px), static_cast<float>(area.top_px),
          static_cast<float>(area.width_px), static_cast<float>(area.height_px)};
}

}  // namespace

PixelArea fitInto(const PixelArea& area, double aspect) {
  const double width_px =
      std::max(1.0, std::round(std::min(area.width_px, area.height_px * aspect)));
  const double height_px =
      std::max(1.0, std::round(std::min(area.height_px, area.width_px / aspect)));
  return {.left_px = area.left_px + std::floor((area.width_px - width_px) / 2),
          .top_px = area.top_px + std::floor((area.height_px - height_px) / 2),
          .width_px = width_px,
          .height_px = height_px};
}

absl::StatusOr<std::unique_ptr<Painter>> Painter::make(bool is_gles) {
  absl::StatusOr<GlProgram> weave = GlProgram::make(kWindowVertex, kWeaveFragment, is_gles);
  if (!weave.ok()) return weave.status();
  absl::StatusOr<GlProgram> place = GlProgram::make(kWindowVertex, kPlaceFragment, is_gles);
  if (!place.ok()) return place.status();
  absl::StatusOr<GlProgram> tune = GlProgram::make(kWindowVertex, kTuneFragment, is_gles);
  if (!tune.ok()) return tune.status();
  return std::unique_ptr<Painter>(
      new Painter(*std::move(weave), *std::move(place), *std::move(tune)));
}

Painter::Painter(GlProgram weave, GlProgram place, GlProgram tune)
    : weave_(std::move(weave)), place_(std::move(place)), tune_(std::move(tune)) {
  glGenVertexArrays(1, &vertices_);
  glBindVertexArray(vertices_);
}

Painter::~Painter() {
  glDeleteVertexArrays(1, &vertices_);
}

void Painter::begin(SizePx window_px) {
  window_px_ = window_px;
  glViewport(0, 0, static_cast<int>(window_px.width), static_cast<int>(window_px.height));
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void Painter::useLenses(const GlProgram& program, const Calibration& calibration) const {
  const abi::Lenticular lens = makeLenticular(calibration);
  program.use();
  program.set("lens.height_px", lens.height_px);
  program.set("lens.phase_per_column", lens.phase_per_column);
  program.set("lens.phase_per_row", lens.phase_per_row);
  program.set("lens.cell_mode", lens.cell_mode);
  program.set("lens.cell_count", lens.cell_count);
  program.set("lens.is_inverted", lens.is_inverted);
  program.set("lens.cell_phase", std::span<const uint32_t>(lens.cell_phase));
  program.set("panel_size_px", sizeAsFloats(calibration.screen_px));
  program.set("window_height_px", window_px_.height);
}

void Painter::weave(const GlTexture& atlas, const v1::AtlasLayout& layout,
                    const Calibration& calibration, bool is_blended) {
  useLenses(weave_, calibration);
  weave_.set("atlas_size_px", sizeAsFloats(atlas.sizePx()));
  weave_.set("tile_size_px",
             sizeAsFloats({layout.tile_size().width(), layout.tile_size().height()}));
  weave_.set("padding_top_px", static_cast<float>(layout.padding_top_px()));
  weave_.set("tile_count", std::array<uint32_t, 2>{layout.columns(), layout.rows()});
  weave_.set("view_count", layout.view_count());
  weave_.set("is_bottom_left", layout.order() == v1::TILE_ORDER_BOTTOM_LEFT ? 1u : 0u);
  weave_.set("is_blended", is_blended ? 1u : 0u);
  atlas.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Painter::place(const GlTexture& picture, const PixelArea& source, const PixelArea& target) {
  const auto height_px = static_cast<int>(window_px_.height);
  const auto left_px = static_cast<int>(target.left_px);
  const auto bottom_px = height_px - static_cast<int>(target.top_px + target.height_px);
  place_.use();
  place_.set("picture_size_px", sizeAsFloats(picture.sizePx()));
  place_.set("source_px", areaAsFloats(source));
  place_.set("target_px", areaAsFloats(target));
  place_.set("window_height_px", static_cast<float>(height_px));
  picture.bind();
  glEnable(GL_SCISSOR_TEST);
  glScissor(left_px, bottom_px, static_cast<int>(target.width_px),
            static_cast<int>(target.height_px));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
}

void Painter::tune(const Calibration& calibration) {
  useLenses(tune_, calibration);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

namespace {

constexpr int kEm_px = 22;
constexpr double kMargin_px = 16;

}  // namespace

absl::StatusOr<std::unique_ptr<TextOverlay>> TextOverlay::make() {
  absl::StatusOr<std::unique_ptr<Font>> font = Font::open(kEm_px);
  if (!font.ok()) return font.status();
  return std::unique_ptr<TextOverlay>(new TextOverlay(*std::move(font)));
}

absl::Status TextOverlay::draw(const std::string& text, Painter& painter) {
  const absl::StatusOr<WrittenText> written = font_->write(text);
  if (!written.ok()) return written.status();
  std::vector<uint8_t> samples;
  samples.reserve(4 * written->coverage.size());
  for (const uint8_t white : written->coverage) {
    samples.insert(samples.end(), {white, white, white, 255});
  }
  VIEWLOOM_RETURN_IF_ERROR(texture_.upload(written->size_px, 4, samples));
  const PixelArea whole{.width_px = static_cast<double>(written->size_px.width),
                        .height_px = static_cast<double>(written->size_px.height)};
  PixelArea target = whole;
  target.left_px = target.top_px = kMargin_px;
  painter.place(texture_, whole, target);
  return absl::OkStatus();
}

}  // namespace viewloom::show
