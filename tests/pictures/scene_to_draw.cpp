// SPDX-License-Identifier: Apache-2.0
#include "pictures/scene_to_draw.h"

#include <cmath>
#include <memory>
#include <vector>

#include "gpu/walk_under_test.h"

namespace viewloom::pictures {
namespace {

constexpr double kFocal_px = 80;
constexpr double kEye_x_m = 0.25;

// Red in the low byte.
constexpr uint32_t kBoardColor = 0xff3a86e0u;
constexpr uint32_t kBallColor = 0xffb06a30u;
constexpr uint32_t kStripeColors[] = {0xffc8d8b8u, 0xff8fb078u};
constexpr int kStripe_px = 3;

double wallAt(int column) {
  return 0.24 + 0.002 * column;
}

bool isBoard(int column, int row) {
  return column >= 18 && column < 27 && row >= 12 && row < 52;
}
double boardAt(int column) {
  return 0.66 + 0.012 * (column - 18);
}

constexpr double kBallRadius_px = 6.5;
double fromBall_px(int column, int row) {
  return std::hypot(column + 0.5 - 41.0, row + 0.5 - 30.5);
}
bool isBall(int column, int row) {
  return fromBall_px(column, row) < kBallRadius_px;
}
double ballAt(int column, int row) {
  const double share = fromBall_px(column, row) / kBallRadius_px;
  return 0.56 + 0.1 * std::sqrt(1 - share * share);
}

}  // namespace

oracle::Scene sceneToDraw() {
  oracle::Scene scene;
  scene.name = "board and ball";
  scene.planes = oracle::makePlanes(kSceneSize_px, kSceneSize_px, 2);
  for (int row = 0; row < kSceneSize_px; ++row) {
    for (int column = 0; column < kSceneSize_px; ++column) {
      const bool is_board = isBoard(column, row);
      const bool is_ball = isBall(column, row);
      scene.planes.at(0, column, row) = float(is_board  ? boardAt(column)
                                              : is_ball ? ballAt(column, row)
                                                        : wallAt(column));
      if (is_board) scene.planes.at(1, column, row) = float(wallAt(column));
    }
  }
  scene.pinhole = {{kFocal_px, kFocal_px}, {0.5 * kSceneSize_px, 0.5 * kSceneSize_px}};
  scene.kappa = {0, 0.02f};
  return scene;
}

FramePtr frameToDraw() {
  auto frame = std::make_shared<Frame>(*frameOf(sceneToDraw()));
  for (size_t layer = 0; layer < frame->sources[0].size(); ++layer) {
    auto bytes = std::make_shared<std::vector<uint8_t>>();
    for (int row = 0; row < kSceneSize_px; ++row) {
      for (int column = 0; column < kSceneSize_px; ++column) {
        const bool is_first = layer == 0;
        const uint32_t color = is_first && isBoard(column, row) ? kBoardColor
                               : is_first && isBall(column, row)
                                   ? kBallColor
                                   : kStripeColors[column / kStripe_px % 2];
        for (int shift = 0; shift < 32; shift += 8) bytes->push_back(uint8_t(color >> shift));
      }
    }
    frame->sources[0][layer].color = bytes;
  }
  return frame;
}

oracle::OutputView viewToDraw() {
  oracle::OutputView view = oracle::ownView(sceneToDraw());
  view.position_m = {kEye_x_m, 0, 0};
  view.height = 1;
  view.pinhole.principal_px.y -= kDrawnRow;
  return view;
}

}  // namespace viewloom::pictures
