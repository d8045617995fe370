// SPDX-License-Identifier: Apache-2.0
#include "show/show_settings.h"

#include <SDL_keycode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::show::show_settings_test {
namespace {

constexpr ShowAbilities kPanel = {.can_weave = true, .can_native = true};

v1::AtlasLayout layoutOf(uint32_t view_count) {
  v1::AtlasLayout layout;
  layout.set_view_count(view_count);
  layout.set_focal_distance_m(2);
  layout.set_view_cone_rad(0.7);
  return layout;
}

TEST(ShowModes, haveNamesThatLeadBackToThem) {
  for (const char* name : {"native", "weave", "view", "pair", "quilt"}) {
    EXPECT_EQ(nameOf(modeNamed(name).value()), name);
  }
  EXPECT_EQ(modeNamed("woven"), std::nullopt);
}

TEST(ShowModes, followOneAnotherAndAskAnewOnlyWhereTheDisplayChanges) {
  ShowSettings settings{.mode = ShowMode::kNative};
  const v1::AtlasLayout layout = layoutOf(48);
  const auto next = [&] { return applyAction(ShowAction::kNextMode, layout, kPanel, settings); };
  EXPECT_EQ(next(), ShowEffect::kNewDisplay);
  EXPECT_EQ(settings.mode, ShowMode::kWeave);
  EXPECT_EQ(next(), ShowEffect::kRedraw);
  EXPECT_EQ(next(), ShowEffect::kRedraw);
  EXPECT_EQ(next(), ShowEffect::kRedraw);
  EXPECT_EQ(settings.mode, ShowMode::kQuilt);
  EXPECT_EQ(next(), ShowEffect::kNewDisplay);
  EXPECT_EQ(settings.mode, ShowMode::kNative);
}

TEST(ShowModes, passOverWhatCannotBeShownHere) {
  ShowSettings settings{.mode = ShowMode::kQuilt};
  applyAction(ShowAction::kNextMode, layoutOf(48), {.can_weave = true}, settings);
  EXPECT_EQ(settings.mode, ShowMode::kWeave);
  settings.mode = ShowMode::kQuilt;
  applyAction(ShowAction::kNextMode, layoutOf(48), {}, settings);
  EXPECT_EQ(settings.mode, ShowMode::kView);
}

TEST(ShowViews, startInTheMiddleAndStopAtTheEnds) {
  ShowSettings settings{.mode = ShowMode::kView};
  const v1::AtlasLayout layout = layoutOf(4);
  EXPECT_EQ(firstView(settings, layout), 2u);
  for (const uint32_t expected : {3u, 3u}) {
    applyAction(ShowAction::kNextView, layout, {}, settings);
    EXPECT_EQ(firstView(settings, layout), expected);
  }
  for (const uint32_t expected : {2u, 1u, 0u, 0u}) {
    applyAction(ShowAction::kPreviousView, layout, {}, settings);
    EXPECT_EQ(firstView(settings, layout), expected);
  }
  EXPECT_EQ(applyAction(ShowAction::kNextView, layoutOf(0), {}, settings), ShowEffect::kNone);
}

TEST(ShowViews, ofAPairLieAroundTheMiddle) {
  ShowSettings settings{.mode = ShowMode::kPair};
  EXPECT_EQ(firstView(settings, layoutOf(48)), 20u);
  EXPECT_EQ(secondView(settings, layoutOf(48)), 26u) << "an eighth of 48 further";
  EXPECT_EQ(firstView(settings, layoutOf(2)), 0u);
  EXPECT_EQ(secondView(settings, layoutOf(2)), 1u);
  EXPECT_EQ(secondView(settings, layoutOf(1)), 0u);
  settings.pair_distance = 100;
  EXPECT_EQ(firstView(settings, layoutOf(48)), 0u);
  EXPECT_EQ(secondView(settings, layoutOf(48)), 47u);
}

TEST(ShowFocus, isTheLayoutsUntilItIsChangedAndStaysWithinTheApi) {
  ShowSettings settings;
  v1::AtlasLayout layout = layoutOf(4);
  EXPECT_EQ(applyAction(ShowAction::kFocusNearer, layout, {}, settings), ShowEffect::kNewDisplay);
  EXPECT_DOUBLE_EQ(settings.focal_distance_m, 2 / 1.05);
  applyAction(ShowAction::kFocusFurther, layout, {}, settings);
  EXPECT_DOUBLE_EQ(settings.focal_distance_m, 2);
  settings.view_cone_rad = 2.59;
  applyAction(ShowAction::kWiderCone, layout, {}, settings);
  EXPECT_EQ(settings.view_cone_rad, 2.6);
  layout.set_focal_distance_m(0);
  EXPECT_EQ(applyAction(ShowAction::kFocusNearer, layout, {}, settings), ShowEffect::kNone)
      << "this display has no focus";
}

TEST(ShowDisplay, isWhatWasAskedForWithWhatKeysChanged) {
  v1::Display asked;
  asked.mutable_quilt()->set_preset("portrait");
  asked.set_tolerance_px(0.5);
  ShowSettings settings{.mode = ShowMode::kWeave};
  EXPECT_EQ(displayFor(settings, asked, std::nullopt).SerializeAsString(),
            asked.SerializeAsString());
  settings.focal_distance_m = 3;
  settings.view_cone_rad = 0.5;
  const v1::Display changed = displayFor(settings, asked, std::nullopt);
  EXPECT_EQ(changed.quilt().preset(), "portrait");
  EXPECT_EQ(changed.quilt().focal_distance_m(), 3);
  EXPECT_EQ(changed.quilt().view_cone_rad(), 0.5);
}

TEST(ShowDisplay, ofTheNativeModeIsThePanelItself) {
  v1::Display asked;
  asked.mutable_quilt()->set_preset("portrait");
  asked.mutable_quilt()->set_fov_y_rad(0.25);
  asked.set_tolerance_px(0.5);
  const Calibration calibration{
      .pitch = 50, .slope = -7, .dpi = 324, .screen_px = {1536, 2048}, .serial = "LKG-P"};
  const v1::Display display = displayFor(
      {.mode = ShowMode::kNative, .focal_distance_m = 3, .view_cone_rad = 0.5}, asked, calibration);
  ASSERT_TRUE(display.has_lenticular());
  EXPECT_EQ(*parseCalibration(display.lenticular().calibration_json()), calibration);
  EXPECT_EQ(display.lenticular().focal_distance_m(), 3);
  EXPECT_EQ(display.lenticular().view_cone_rad(), 0.5);
  EXPECT_EQ(display.lenticular().fov_y_rad(), 0.25);
  EXPECT_EQ(display.tolerance_px(), 0.5);
}

TEST(ShowKeys, areThoseOfTheManual) {
  EXPECT_EQ(actionOfKey(SDLK_ESCAPE), ShowAction::kQuit);
  EXPECT_EQ(actionOfKey(SDLK_f), ShowAction::kToggleFullScreen);
  EXPECT_EQ(actionOfKey(SDLK_b), ShowAction::kToggleBlend);
  EXPECT_EQ(actionOfKey(SDLK_z), std::nullopt);
}

}  // namespace
}  // namespace viewloom::show::show_settings_test
