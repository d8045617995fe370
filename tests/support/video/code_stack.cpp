// SPDX-License-Identifier: Apache-2.0
// Codes views as video, for tests and measurements of clients without a server.
// Arguments: view width, view height, view count, quantisation (20..51), and "chained" where
// atlases are to refer to the one before. Standard input: atlases of views, each
// uint8_t[view][y][x][3] R, G, B. For each atlas it writes a line of JSON and the access units, in
// the order of coding: {"video": ..., "picture_bytes": [...]}, where video has the fields of proto
// VideoStack. Every other atlas of a chain is coded backward.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "display/video_stack.h"
#include "shared/ycbcr.h"
#include "support/video/sample_picture.h"
#include "video/h264_parameters.h"
#include "video/openh264_encoder.h"
#include "video/view_format.h"

namespace viewloom::test {
namespace {

struct Views {
  SizePx view_px;
  std::vector<uint8_t> rgb;

  const uint8_t* pixel(uint32_t view, uint32_t x, uint32_t y) const {
    const uint32_t column = std::min(x, view_px.width - 1);
    const uint32_t row = std::min(y, view_px.height - 1);
    return &rgb[3 * ((size_t{view} * view_px.height + row) * view_px.width + column)];
  }
};

void putBlock(SamplePicture& picture, uint32_t left, uint32_t top, const Views& views,
              uint32_t view, uint32_t x, uint32_t y) {
  uint32_t cb_sum = 0;
  uint32_t cr_sum = 0;
  for (const uint32_t row : {y, y + 1}) {
    for (const uint32_t column : {x, x + 1}) {
      const uint8_t* const rgb = views.pixel(view, column, row);
      picture.luma(left + column, top + row) = uint8_t(abi::lumaOf(rgb[0], rgb[1], rgb[2]));
      cb_sum += abi::cbOf(rgb[0], rgb[1], rgb[2]);
      cr_sum += abi::crOf(rgb[0], rgb[1], rgb[2]);
    }
  }
  picture.cb(left + x, top + y) = uint8_t(abi::meanChroma(cb_sum, x / 2));
  picture.cr(left + x, top + y) = uint8_t(abi::meanChroma(cr_sum, x / 2));
}

// Pixels of the cell beyond the view repeat its edge.
void putView(SamplePicture& picture, SizePx cell_px, const StackCell& cell, const Views& views,
             uint32_t view) {
  for (uint32_t y = 0; y < cell_px.height; y += 2) {
    for (uint32_t x = 0; x < cell_px.width; x += 2) {
      putBlock(picture, cell.column * cell_px.width, cell.row * cell_px.height, views, view, x, y);
    }
  }
}

std::string sizeText(SizePx size_px) {
  return strCat("{\"width\":", size_px.width, ",\"height\":", size_px.height, "}");
}

std::string headerOf(const VideoStack& stack, const std::vector<std::vector<uint8_t>>& units) {
  std::string sizes;
  for (const auto& unit : units) sizes += strCat(sizes.empty() ? "" : ",", unit.size());
  return strCat("{\"video\":{\"picture_count\":", stack.picture_count,
                ",\"picture_size\":", sizeText(stack.pictureSize()), ",\"columns\":", stack.columns,
                ",\"rows\":", stack.rows, ",\"cell_size\":", sizeText(stack.cell_px),
                ",\"codec_string\":\"", codedVideoString(stack.pictureSize()),
                "\",\"color_matrix\":\"BT601\",\"full_range\":true},\"picture_bytes\":[", sizes,
                "]}\n");
}

// Its first picture refers to the one before where it has to.
absl::Status writeAtlas(const Views& views, const VideoStack& stack, Reference first,
                        PictureOrder order, VideoEncoder& encoder) {
  std::vector<std::vector<uint8_t>> units(stack.picture_count);
  for (uint32_t place = 0; place < stack.picture_count; ++place) {
    const uint32_t picture =
        order == PictureOrder::kForward ? place : stack.picture_count - 1 - place;
    SamplePicture sample(stack.pictureSize());  // black where no view is
    for (uint32_t view = picture; view < stack.view_count; view += stack.picture_count) {
      putView(sample, stack.cell_px, stack.cellOf(view), views, view);
    }
    VIEWLOOM_RETURN_IF_ERROR(encoder.encode(
        sample.video(), place == 0 ? first : Reference::kPictureBefore, units[place]));
  }
  std::cout << headerOf(stack, units);
  for (const auto& unit : units) {
    std::cout.write(reinterpret_cast<const char*>(unit.data()), std::streamsize(unit.size()));
  }
  return absl::OkStatus();
}

absl::Status codeAll(SizePx view_px, uint32_t view_count, uint32_t qp, Prediction prediction) {
  const absl::StatusOr<VideoStack> stack = planVideoStack(view_px, view_count);
  VIEWLOOM_RETURN_IF_ERROR(stack.status());
  const auto encoder = OpenH264Encoder::make(viewFormat(stack->pictureSize(), qp));
  VIEWLOOM_RETURN_IF_ERROR(encoder.status());
  const bool is_chained = prediction == Prediction::kAcrossAtlases;
  auto first = Reference::kNone;
  auto order = PictureOrder::kForward;
  Views views{.view_px = view_px, .rgb = std::vector<uint8_t>(view_px.area() * 3 * view_count)};
  while (
      std::cin.read(reinterpret_cast<char*>(views.rgb.data()), std::streamsize(views.rgb.size()))) {
    VIEWLOOM_RETURN_IF_ERROR(writeAtlas(views, *stack, first, order, **encoder));
    if (!is_chained) continue;
    first = Reference::kPictureBefore;
    order = order == PictureOrder::kForward ? PictureOrder::kBackward : PictureOrder::kForward;
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace viewloom::test

int main(int argc, char** argv) {
  const bool is_chained = argc == 6 && std::string_view(argv[5]) == "chained";
  if (argc != 5 && !is_chained) {
    std::cerr << "code_stack: expected are view width, view height, view count and quantisation, "
                 "then perhaps \"chained\"\n";
    return 2;
  }
  const auto number = [argv](int index) { return uint32_t(std::atoi(argv[index])); };
  const absl::Status status = viewloom::test::codeAll(
      {number(1), number(2)}, number(3), number(4),
      is_chained ? viewloom::Prediction::kAcrossAtlases : viewloom::Prediction::kWithinAtlas);
  if (!status.ok()) std::cerr << "code_stack: " << status << "\n";
  return status.ok() ? 0 : 1;
}
