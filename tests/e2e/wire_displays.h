// SPDX-License-Identifier: Apache-2.0
// Small displays of every kind, as messages.
#pragma once

#include "viewloom/v1/display_service.pb.h"

namespace viewloom::test {

// Opens one atlas of stream "scene", with exact colours.
inline v1::OpenDisplay openScene() {
  v1::OpenDisplay open;
  open.set_stream("scene");
  open.set_count(1);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  return open;
}

// Views as H.264. `qp`: 0 = as the server chooses.
inline v1::OpenDisplay asVideo(v1::OpenDisplay open, uint32_t qp) {
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
  open.mutable_encoding()->set_video_qp(qp);
  return open;
}

// 20 views, and pixels beside them.
inline v1::OpenDisplay smallQuilt() {
  v1::OpenDisplay open = openScene();
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(5);
  quilt.set_rows(4);
  quilt.mutable_size()->set_width(327);
  quilt.mutable_size()->set_height(246);
  return open;
}

inline v1::CamerasDisplay& cameraGrid(v1::OpenDisplay& open) {
  v1::CamerasDisplay& cameras = *open.mutable_display()->mutable_cameras();
  cameras.mutable_tile_size()->set_width(61);
  cameras.mutable_tile_size()->set_height(39);
  v1::CameraGrid& grid = *cameras.mutable_grid();
  grid.set_columns(3);
  grid.set_rows(2);
  grid.set_spacing_x_m(0.1);
  grid.set_spacing_y_m(0.08);
  return cameras;
}

inline v1::StereoDisplay& eyes(v1::OpenDisplay& open) {
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.mutable_eye_size()->set_width(75);
  stereo.mutable_eye_size()->set_height(131);
  return stereo;
}

// A panel of 201 x 130 px.
inline v1::LenticularDisplay& panel(v1::OpenDisplay& open) {
  v1::LenticularDisplay& lenticular = *open.mutable_display()->mutable_lenticular();
  lenticular.set_calibration_json(
      R"({"pitch":{"value":40},"slope":{"value":-6.5},"center":{"value":0.3},)"
      R"("DPI":{"value":320},"screenW":{"value":201},"screenH":{"value":130}})");
  return lenticular;
}

inline v1::IntegralDisplay& microlenses(v1::OpenDisplay& open) {
  v1::IntegralDisplay& integral = *open.mutable_display()->mutable_integral();
  integral.set_preset("near_eye_2013");
  integral.mutable_panel_size()->set_width(320);
  integral.mutable_panel_size()->set_height(180);
  return integral;
}

// One camera, about as wide as the synthetic scene's.
inline void cameraList(v1::OpenDisplay& open) {
  v1::CamerasDisplay& cameras = cameraGrid(open);
  cameras.clear_grid();
  v1::Fov& fov = *cameras.add_cameras()->mutable_fov();
  fov.set_angle_left_rad(-0.4);
  fov.set_angle_right_rad(0.4);
  fov.set_angle_down_rad(-0.3);
  fov.set_angle_up_rad(0.3);
}

inline void colorAndDepth(v1::OpenDisplay& open) {
  v1::RgbdDisplay& rgbd = *open.mutable_display()->mutable_rgbd();
  rgbd.set_form(v1::RGBD_FORM_COLOR_DEPTH);
  rgbd.mutable_view_size()->set_width(96);
  rgbd.mutable_view_size()->set_height(64);
}

}  // namespace viewloom::test
