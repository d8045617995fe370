// SPDX-License-Identifier: Apache-2.0
#include "lens/band_gatherer.h"

#include <algorithm>
#include <cmath>

#include "base/srgb.h"
#include "lens/open_rays.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr uint32_t kSide_px = abi::kMetBlockSide_px;
static_assert(kSide_px == kLensPatternSide_px, "points of a block are those of the pattern");

constexpr uint32_t kOpaqueBlack = 0xff000000;

// The same as besideOf in shaders/lib/lens/lens_rays.glsl.
float besideOf(uint32_t point, double step) {
  const double place = 0.5 + point * step;
  return float(place - std::floor(place) - 0.5);
}

// Rays that are gathered at once, but for whole blocks: about a millisecond of a core.
constexpr uint32_t kGatheredRays = 160'000;

// The first row after this one with which blocks begin.
uint32_t nextBlockRow(const AtlasLayout& layout, uint32_t row) {
  if (row < layout.padding_top_px) return layout.padding_top_px;
  const uint32_t height_px = layout.tile_size_px.height;
  const uint32_t y = (row - layout.padding_top_px) % height_px;
  return row - y + std::min((y / kSide_px + 1) * kSide_px, height_px);
}

// The most that rays are moved by for a metre, px: nothing that is made of them overflows.
constexpr float kMoved_px_max = 1e12F;

bool isBounded(const abi::vec3& moved) {
  return std::abs(moved.x) < kMoved_px_max && std::abs(moved.y) < kMoved_px_max &&
         std::abs(moved.z) < kMoved_px_max;
}

// Where rays hardly go forward, blocks of px see all of the source.
bool looksForward(const abi::ViewParams& view, SizePx tile_px) {
  const abi::vec3 lens_x = view.lens_px_m.x * view.direction_dx;
  const abi::vec3 lens_y = view.lens_px_m.y * view.direction_dy;
  if (!isBounded(view.eye) || !isBounded(lens_x) || !isBounded(lens_y)) return false;
  const float beside = view.lens_inv_focus * (std::abs(lens_x.z) + std::abs(lens_y.z));
  const auto isForward = [&](uint32_t x, uint32_t y) {
    const abi::vec3 direction =
        view.direction + float(x) * view.direction_dx + float(y) * view.direction_dy;
    return direction.z - beside > abi::kForwardMin && isBounded(direction);
  };
  return isForward(0, 0) && isForward(tile_px.width, 0) && isForward(0, tile_px.height) &&
         isForward(tile_px.width, tile_px.height);
}

uint64_t rowRays(const AtlasLayout& layout) {
  return uint64_t{layout.size_px.width} * layout.lens->pointCount();
}

void addLight(uint32_t texel, float count, uint32_t p, BlockLight& light) {
  const std::array<float, 256>& of_codes = lightOfCodes();
  light.red[p] += count * of_codes[texel & 255];
  light.green[p] += count * of_codes[texel >> 8 & 255];
  light.blue[p] += count * of_codes[texel >> 16 & 255];
  light.count[p] += count;
}

// The first of these rows that have so many rays, or one row of blocks.
BandRows firstRows(const AtlasLayout& layout, BandRows rows, uint64_t ray_count) {
  const uint32_t end = rows.first_row + rows.row_count;
  const uint64_t enough = std::max<uint64_t>(ray_count / rowRays(layout), 1);
  uint32_t row = rows.first_row;
  while (row < end && row - rows.first_row < enough) row = nextBlockRow(layout, row);
  return {rows.first_row, std::min(row, end) - rows.first_row};
}

// Columns of pieces that have so many rays in so many rows, or a column of blocks; wider than any
// atlas where those have fewer.
uint32_t columnsOfPiece(const AtlasLayout& layout, uint32_t row_count, uint64_t ray_count) {
  const uint64_t column_rays = uint64_t{row_count} * layout.lens->pointCount();
  return uint32_t(std::clamp<uint64_t>(ray_count / column_rays, kSide_px, 1U << 16));
}

}  // namespace

bool gathersOnHost(bool is_in_reach, const TraceJob& job) {
  return is_in_reach && job.hasSecondStage() && !job.layout->lens->is_exact &&
         std::ranges::all_of(job.tilesOf(0), [&](const abi::ViewParams& view) {
           return view.is_used == 0 || looksForward(view, job.layout->tile_size_px);
         });
}

std::vector<GatheredPiece> gatheredPieces(const AtlasLayout& layout, BandRows rows,
                                          uint64_t ray_count_max) {
  const uint64_t ray_count = std::clamp<uint64_t>(ray_count_max, 1, kGatheredRays);
  const uint32_t width_px = layout.size_px.width;
  std::vector<GatheredPiece> pieces;
  while (rows.row_count > 0) {
    const BandRows first = firstRows(layout, rows, ray_count);
    const uint32_t columns = columnsOfPiece(layout, first.row_count, ray_count);
    for (uint32_t column = 0; column < width_px; column += columns) {
      pieces.push_back({first, column, std::min(column + columns, width_px)});
    }
    rows.first_row += first.row_count;
    rows.row_count -= first.row_count;
  }
  return pieces;
}

GatheredBand bandOf(TraceSlot& slot, const AtlasLayout& layout, const GatheredPiece& piece,
                    uint32_t first_row) {
  const size_t width_px = layout.size_px.width;
  const auto rowsOf = [&](auto plane, size_t per_px) {
    if (plane.empty()) return plane;
    return plane.subspan(first_row * width_px * per_px, piece.rows.row_count * width_px * per_px);
  };
  return {.piece = piece,
          .color = rowsOf(slot.mutableColor(), 1),
          .linear = rowsOf(slot.mutableLinear(), 4)};
}

// A tile and its part of a band.
struct BandGatherer::Tile {
  const abi::ViewParams& view;
  uint32_t first_x = 0;   // in the atlas
  int64_t first_row = 0;  // in the band: of the tile's first row
  uint32_t first_y = 0;   // of the tile: rows [first, end) are in the band
  uint32_t end_y = 0;
  uint32_t begin_x = 0;  // blocks of the tile that begin in [begin, end) are gathered
  uint32_t end_x = 0;
};

void BandGatherer::takePoints(const AtlasLayout& layout) {
  constexpr double kStepX = 0.8566748838545029;  // Roberts' R4 sequence
  constexpr double kStepY = 0.7338918566271260;
  const size_t count = layout.lens->pointCount();
  points_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    LensPoint& point = points_[i];
    for (size_t p = 0; p < kBlockArea_px; ++p) {
      const glm::vec2 at = layout.lens_points[i * kBlockArea_px + p];
      point.x[p] = at.x;
      point.y[p] = at.y;
    }
    point.beside_x_px = besideOf(uint32_t(i), kStepX);
    point.beside_y_px = besideOf(uint32_t(i), kStepY);
  }
}

void BandGatherer::gather(const HostStructure& structure, const TraceJob& job,
                          const GatheredBand& band) {
  const AtlasLayout& layout = *job.layout;
  takePoints(layout);
  const SizePx tile_px = layout.tile_size_px;
  const std::span<const abi::ViewParams> tiles = job.tilesOf(0);
  const int64_t first = band.piece.rows.first_row;
  const int64_t end = first + band.piece.rows.row_count;
  for (uint32_t index = 0; index < tiles.size(); ++index) {
    const int64_t tile_row =
        int64_t{layout.padding_top_px} + int64_t{index / layout.columns} * tile_px.height;
    const auto inTile = [&](int64_t row) {
      return uint32_t(std::clamp<int64_t>(row - tile_row, 0, tile_px.height));
    };
    const uint32_t tile_column = index % layout.columns * tile_px.width;
    const auto inTileRow = [&](uint32_t column) {
      return std::clamp(column, tile_column, tile_column + tile_px.width) - tile_column;
    };
    const Tile tile{
        .view = tiles[index],
        .first_x = tile_column,
        .first_row = tile_row - first,
        .first_y = inTile(first),
        .end_y = inTile(end),
        .begin_x = (inTileRow(band.piece.first_column) + kSide_px - 1) / kSide_px * kSide_px,
        .end_x = inTileRow(band.piece.end_column)};
    // Those that show depth have no lens.
    if (tile.view.is_used == 0 || tile.view.lens_px_m.x == 0) continue;
    if (tile.first_y == tile.end_y) continue;
    for (uint32_t y = tile.first_y / kSide_px * kSide_px; y < tile.end_y; y += kSide_px) {
      for (uint32_t x = tile.begin_x; x < tile.end_x; x += kSide_px) {
        gatherBlock(structure, job, tile, {x, y}, band);
      }
    }
  }
}

// The first rays look at all sheets; what none of them met, the others do not look for.
void BandGatherer::gatherRays(GatheredRays rays, uint32_t first_count) {
  const std::span<const LensPoint> points = rays.points;
  rays.points = points.first(first_count);
  open_.clear();
  MetSheets met = gatherOnSheets(rays, light_, &open_);
  guess(rays);
  met_.clear();
  for (size_t i = 0; i < rays.sheets.size(); ++i) {
    if ((met.sheets >> i & 1) != 0) met_.push_back(rays.sheets[i]);
  }
  rays.points = points.subspan(first_count);
  if (!met_.empty()) rays.sheets = met_;
  if (met_.size() == 1 && met.is_all) {
    gatherOnSheet(rays, light_);
  } else {
    const MetSheets of_others = gatherOnSheets(rays, light_, nullptr);
    for (size_t p = 0; p < kBlockArea_px; ++p) met.open_count[p] += of_others.open_count[p];
  }
  addGuesses(met.open_count);
}

// The answer for every open ray of the first stage serves rays of the second.
void BandGatherer::guess(const GatheredRays& rays) {
  guesses_ = {};
  for (const OpenRay& open : open_) {
    const int32_t texel = guessSeen(rays, open);
    addLight(texel < 0 ? middle_[open.px] : rays.structure.color[texel], 1, open.px, guesses_);
  }
}

void BandGatherer::addGuesses(const OfBlock& open_count) {
  for (uint32_t p = 0; p < kBlockArea_px; ++p) {
    if (open_count[p] == 0) continue;
    if (guesses_.count[p] == 0) {
      addLight(middle_[p], open_count[p], p, light_);
      continue;
    }
    const float share = open_count[p] / guesses_.count[p];
    light_.red[p] += share * guesses_.red[p];
    light_.green[p] += share * guesses_.green[p];
    light_.blue[p] += share * guesses_.blue[p];
    light_.count[p] += open_count[p];
  }
}

void BandGatherer::gatherBlock(const HostStructure& structure, const TraceJob& job,
                               const Tile& tile, glm::uvec2 block_px, const GatheredBand& band) {
  const AtlasLayout& layout = *job.layout;
  const glm::uvec2 end_px = {std::min(block_px.x + kSide_px, layout.tile_size_px.width),
                             std::min(block_px.y + kSide_px, layout.tile_size_px.height)};
  list_.find(structure, tile.view, glm::vec2(block_px), glm::vec2(end_px));
  const GatheredRays rays{.structure = structure,
                          .view = tile.view,
                          .first_x_px = float(block_px.x),
                          .first_y_px = float(block_px.y),
                          .points = points_,
                          .sheets = list_.sheets(),
                          .may_leave = list_.mayLeave(),
                          .fills_border = job.outside_fill == OutsideFill::kBorder,
                          .background = redFirst(job.background_rgb) | kOpaqueBlack};
  const uint32_t first_y = std::max(block_px.y, tile.first_y);
  const uint32_t end_y = std::min(end_px.y, tile.end_y);
  const auto firstOfRow = [&](uint32_t y) {
    return size_t(tile.first_row + y) * layout.size_px.width + tile.first_x + block_px.x;
  };
  const auto inBlock = [&](uint32_t y) { return size_t{y - block_px.y} * kSide_px; };
  const uint32_t width = end_px.x - block_px.x;
  light_ = {};
  if (list_.isSettled()) {
    gatherOnSheet(rays, light_);
  } else {
    middle_.fill(0);
    for (uint32_t y = first_y; y < end_y; ++y) {
      std::copy_n(&band.color[firstOfRow(y)], width, &middle_[inBlock(y)]);
    }
    gatherRays(rays, layout.lens->walked_count);
  }
  meanOf(light_, codes_);
  for (uint32_t y = first_y; y < end_y; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const size_t from = inBlock(y) + x;
      const size_t to = firstOfRow(y) + x;
      const bool is_guessed = (band.color[to] & kOpaqueBlack) == 0;
      band.color[to] |= kOpaqueBlack;
      if (is_guessed || light_.count[from] == 0) continue;  // it stays as it was walked
      // The fit of the curve of sRGB may be a little off both ends.
      const auto within = [](float code) { return std::clamp(code, 0.0F, 255.0F); };
      const float codes[] = {within(codes_.red[from]), within(codes_.green[from]),
                             within(codes_.blue[from])};
      band.color[to] = uint32_t(codes[0] + 0.5F) | uint32_t(codes[1] + 0.5F) << 8 |
                       uint32_t(codes[2] + 0.5F) << 16 | kOpaqueBlack;
      if (band.linear.empty()) continue;
      for (size_t c = 0; c < 3; ++c) band.linear[4 * to + c] = codes[c] / 255;
    }
  }
}

}  // namespace viewloom
