// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <string_view>

#include "fuzz/seeds.h"
#include "unit/calibration/device_files.h"

namespace viewloom {
namespace {

SeedBytes seedsOf(std::initializer_list<std::string_view> texts) {
  SeedBytes seeds;
  for (const std::string_view text : texts) seeds.emplace_back(text.begin(), text.end());
  return seeds;
}

}  // namespace

SeedBytes displayJsonSeeds() {
  return seedsOf({R"({"quilt": {"preset": "portrait", "size": {"width": 420, "height": 560}}})",
                  R"({"stereo": {"eyeSize": {"width": 96, "height": 64}, "tracked": true},
           "quality": "QUALITY_BEST", "outside_fill": "OUTSIDE_FILL_BACKGROUND"})",
                  R"({"cameras": {"cameras": [{"pose": {"position": {"x": 1e-1, "y": -0.0}},
           "fov": {"angleLeftRad": -0.5, "angleRightRad": 0.5,
           "angleUpRad": 0.4, "angleDownRad": -0.4}}],
           "tileSize": {"width": 8, "height": 8}}})",
                  R"({"rgbd": {"viewSize": {"width": 16, "height": 12}}, "backgroundRgb": 255,
           "effects": {"temporal": {"outputRateHz": 30}, "lens": {"apertureRadiusM": 0.05}}})"});
}

SeedBytes calibrationSeeds() {
  return seedsOf({kPortraitFile, kThirdGenerationFile});
}

SeedBytes viewerSeeds() {
  return seedsOf(
      {"{\"shown\": 17}\n{\"ping\": \"3\"}\n"
       "{\"change\": {\"display\": {\"quilt\": {\"preset\": \"portrait\"}}}}",
       "{\"change\": {\"display\": {\"stereo\": {\"eyeSize\": {\"width\": 9, \"height\": 9}}},\n"
       "{\"change\": {\"display\": {\"stereo\": {\"eyeSize\": {\"width\": 9, \"height\": 9}}}, "
       "\"encoding\": {\"jpegQuality\": 70, \"withDepth\": true}}}",
       "{\"eye_poses\": {\"time_ns\": \"8\", \"eyes\": [{\"pose\": {\"position\": {\"x\": 0.1}}, "
       "\"fov\": {\"angle_left_rad\": -0.5, \"angle_right_rad\": 0.5}}]}}\n"
       "{\"presented\": {\"sequence\": \"3\"}}\n{\"clock_probe\": {\"client_time_ns\": \"1\"}}"});
}

SeedBytes httpSeeds() {
  return seedsOf({"/still/s/portrait?width=1680&height=1680\nlocalhost:8080\nhttp://localhost:8080",
                  "/still/s_qs2x2a0.75.jpg?width=16&height=12\n127.0.0.1:8080\n",
                  "/ws?stream=s&display=%7B%22stereo%22:%7B%22eyeSize%22:%7B%22width%22:9,"
                  "%22height%22:9%7D%7D%7D&encoding=%7B%22jpegQuality%22:70%7D\n[::1]:80\n"});
}

SeedBytes settingsSeeds() {
  return seedsOf(
      {"device = \"RTX\"\nvalidation = false\n[grpc]\naddress = \"[::1]:50051\"\n"
       "keepalive_s = 10 # s\n[log]\nlevel = 'info'\n",
       "limits.streams_max = 0x10\n[http]\nallowed_hosts = \"\"\"a,\\u0062\"\"\"\n"
       "address = \"localhost:0\"\n[containment]\nreadable = \"/a,/b\"\n"});
}

SeedBytes manifestSeeds() {
  return seedsOf(
      {R"({"number": 2, "sources": [{"camera": {"intrinsics": {"focalXPx": 10, "focalYPx": 10}},
           "layers": [{"color": {"file": "c.png"}, "depth": {"file": "d.exr",
           "depth": {"meaning": "DEPTH_MEANING_PLANAR"}}}]}], "toneMap": "TONE_MAP_AGX"})",
       R"({"views": [{"viewIndex": 3, "color": {"file": "v.png"}}]})"});
}

SeedBytes cameraListSeeds() {
  return seedsOf(
      {R"({"cameras": [{"Name": "v0", "Position": [0.5, -0.25, 1], "Rotation": [10, -5, 0],
           "Depthmap": 1, "Depth_range": [0.5, "inf"], "Resolution": [4, 2],
           "Projection": "Perspective", "Focal": [8.0, 7.0], "Principle_point": [2.0, 1.0],
           "BitDepthColor": 8, "BitDepthDepth": 16, "ColorSpace": "YUV420",
           "DepthColorSpace": "YUV400", "HasInvalidDepth": true}]})"});
}

SeedBytes eyeLineSeeds() {
  return seedsOf({R"({"time_ns": 8, "left": [-0.03, 0, 0.1], "right": [0.03, 0, 0.1]})",
                  R"({"time_ns": 8, "predicted_display_time_ns": 9, "right": [0.03, 0, 0.1],
           "left": {"pose": {"position": {"x": -0.03}, "orientation": {"w": 1}}}})"});
}

}  // namespace viewloom
