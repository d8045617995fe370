// SPDX-License-Identifier: Apache-2.0
#include "cli/plane_options.h"
#include "usage/command_line.h"

#include <map>
#include <string>
#include <vector>

#include "files/depth_packing.h"

namespace viewloom::cli {
namespace {

using inputs::InputKind;
using inputs::InputSettings;

const std::map<std::string, v1::DepthMeaning> kMeanings{{"planar", v1::DEPTH_MEANING_PLANAR},
                                                        {"ray", v1::DEPTH_MEANING_RAY_DISTANCE},
                                                        {"window", v1::DEPTH_MEANING_WINDOW},
                                                        {"disparity", v1::DEPTH_MEANING_DISPARITY}};
const std::map<std::string, v1::ColorTransfer> kTransfers{{"srgb", v1::COLOR_TRANSFER_SRGB},
                                                          {"linear", v1::COLOR_TRANSFER_LINEAR}};
const std::map<std::string, v1::ColorPrimaries> kPrimaries{{"bt709", v1::COLOR_PRIMARIES_BT709},
                                                           {"p3", v1::COLOR_PRIMARIES_DISPLAY_P3},
                                                           {"bt2020", v1::COLOR_PRIMARIES_BT2020}};
const std::map<std::string, v1::AlphaMode> kAlphas{{"opaque", v1::ALPHA_MODE_OPAQUE},
                                                   {"premultiplied", v1::ALPHA_MODE_PREMULTIPLIED},
                                                   {"straight", v1::ALPHA_MODE_STRAIGHT}};
const std::map<std::string, v1::ToneMap> kToneMaps{
    {"clip", v1::TONE_MAP_CLIP}, {"filmic", v1::TONE_MAP_FILMIC}, {"agx", v1::TONE_MAP_AGX}};
const std::map<std::string, v1::ImagePart> kSides{{"right", v1::IMAGE_PART_RIGHT},
                                                  {"left", v1::IMAGE_PART_LEFT},
                                                  {"top", v1::IMAGE_PART_TOP},
                                                  {"bottom", v1::IMAGE_PART_BOTTOM}};
const std::map<std::string, inputs::Projection> kProjections{
    {"flat", inputs::Projection::kFlat}, {"equirect", inputs::Projection::kEquirect}};
const std::map<std::string, bool> kForwards{{"+z", false}, {"-z", true}};

std::map<std::string, v1::DepthPacking> packings() {
  std::map<std::string, v1::DepthPacking> words;
  for (int i = v1::DEPTH_PACKING_RGB24; i <= v1::DepthPacking_MAX; ++i) {
    words[files::nameOf(v1::DepthPacking(i))] = v1::DepthPacking(i);
  }
  return words;
}

std::map<std::string, InputKind> inputKinds() {
  std::map<std::string, InputKind> kinds;
  for (int kind = 0; kind <= int(InputKind::kRecord3d); ++kind) {
    kinds[nameOf(InputKind(kind))] = InputKind(kind);
  }
  return kinds;
}

void addKindOptions(const usage::Command& app, InputSettings& settings) {
  const char* const group = "Input";
  app.addWord(
         "--input", settings.kind, inputKinds(),
         "What wrote the files; every option below overrides what it brings [auto: EXR by its "
         "header, .heic as iphone, else plain]\n"
         "blender   multilayer EXR: Combined and Depth; File Output: Image and Depth\n"
         "unreal    Movie Render Queue EXR: FinalImage and WorldDepth in cm, with its camera\n"
         "nuke      EXR of Nuke: depth is 1/Z\n"
         "arnold, vray, redshift, houdini\n"
         "          EXR with depth in scene units, of any sign; 1e9 and more is infinitely far;\n"
         "          vray, redshift: --depth-near and --depth-far where 0 and 1 stand for them\n"
         "rgbd      one picture, half colour, half depth [between 0.67 and 2 m]\n"
         "2d+z      one picture, half colour, half disparity; --screen, --factor, --screen-code\n"
         "sensor    --depth in whole millimetres, 0 = nothing measured\n"
         "kitti     --depth in 1/256 m; with --baseline disparity in 1/256 px; 0 = nothing\n"
         "tum       --depth in 1/5000 m, 0 = nothing\n"
         "l515      --depth in 0.25 mm, 0 = nothing\n"
         "d405      --depth in 0.1 mm, 0 = nothing\n"
         "record3d  --depth in metres (floats) or millimetres, 0 = nothing\n"
         "openxr    --depth between --depth-near and --depth-far\n"
         "tmiv      --depth of normalised disparity (.png, .yuv), --camera JSON\n"
         "iphone    portrait photo (.heic); or --depth in 1/m (.exr, .pfm), or codes as relative\n"
         "relative  --depth of an estimating network [between 0.67 and 2 m]")
      .group(group);
  app.add("--color-channels,--colour-channels", settings.color_channels,
          "EXR: colour, a layer (beauty) or channels (R,G,B or R,G,B,A) [by their names]")
      .group(group);
  app.add("--depth-channel", settings.depth_channel,
          "EXR: the channel of depth [by its name, as Z, depth.Z or WorldDepth.R]")
      .group(group);
  app.addWord("--depth-side", settings.depth_side, kSides,
              "rgbd, 2d+z: where in the picture depth is [right]")
      .group(group);
  app.addFlag("--black-near", settings.is_black_near,
              "rgbd, iphone, relative: black is near, not white")
      .group(group);
  app.add("--depth-white", settings.white_code,
          "rgbd, 2d+z, iphone, relative, openxr: the code of white, as 4095 for 12 bits in a "
          "file of 16, or 32768 of Photoshop [255 or 65535]")
      .between(1, 65535)
      .group(group);
  app.add("--screen", settings.screen_m, "2d+z: metres to the screen").showDefault().group(group);
  app.add("--factor", settings.factor, "2d+z: strength; 64 is 100 %").showDefault().group(group);
  app.add("--screen-code", settings.screen_code, "2d+z: the code that lies in the screen")
      .between(0, 255)
      .showDefault()
      .group(group);
  app.add("--camera", settings.camera_file, "tmiv: camera parameters in JSON").group(group);
  app.add("--camera-name", settings.camera_name,
          "tmiv: which of the cameras [by the name of the depth file]")
      .group(group);
}

void addDepthOptions(const usage::Command& app, InputSettings& settings) {
  const char* const group = "Depth";
  app.addWord(
         "--depth-meaning", settings.depth_meaning, kMeanings,
         "What a depth sample measures: planar (along the view axis), ray (from the eye), window "
         "(graphics depth 0..1), disparity (1/Z) [planar, or by --input]")
      .group(group);
  const auto addNumber = [&](const char* name, std::optional<double>& value, const char* text) {
    app.add(name, value, text).group(group);
  };
  addNumber("--depth-scale,--scale", settings.depth_scale,
            "Metres (disparity: 1/m) per unit of a sample; 0.001 for millimetres [1]");
  addNumber("--depth-offset", settings.depth_offset, "Added after the scale [0]");
  addNumber("--depth-near", settings.near_m,
            "Metres to the nearest code; window: to the near plane, larger than far for reversed "
            "depth");
  addNumber("--depth-far", settings.far_m, "The same for the farthest; may be inf");
  addNumber(
      "--no-surface-beyond", settings.no_surface_beyond_m,
      "There is no surface farther away than so many metres, as where a renderer hit nothing");
  addNumber("--depth-min", settings.min_depth, "window: smallest depth value [0]");
  addNumber("--depth-max", settings.max_depth, "window: largest depth value [1]");
  addNumber("--depth-invalid", settings.depth_invalid,
            "A sample with exactly this value is no surface");
  app.addFlag("--depth-invalid-is-far", settings.depth_invalid_is_far,
              "... is infinitely far instead, like a sky")
      .group(group);
  app.addFlag("--depth-far-zero", settings.depth_far_zero,
              "Depth 0 is infinitely far: --depth-invalid 0 --depth-invalid-is-far")
      .group(group);
  addNumber("--baseline", settings.baseline_m,
            "Metres between two cameras: depth is their disparity in pixels (with --focal-px)");
  app.addWord(
         "--depth-packing", settings.depth_packing, packings(),
         "Depth packed in colour, 0 at black to 1 at white (--depth-scale: metres at white)\n"
         "rgb24, bgr24    red, or blue, is the lowest byte; white is 1000 m, as CARLA has it\n"
         "rgba32, abgr32  red, or alpha, is the highest byte: three.js since r163, and before\n"
         "rg16, gr16      red, or green, is the high byte\n"
         "float32         the bytes of a float, blue lowest: TartanAir\n"
         "hue             RealSense's colours, between --depth-near and --depth-far")
      .group(group);
  app.addFlag("--flip", settings.flips_depth, "Depth rows are stored upside down").group(group);
  app.add("--connection-tolerance", settings.connection_tolerance,
          "Largest step in 1/Z (1/m) inside one surface; 0 = measured")
      .notNegative()
      .group(group);
}

void addCameraOptions(const usage::Command& app, InputSettings& settings) {
  const char* const group = "Camera";
  app.add("--fov", settings.fov_y_deg,
          "Vertical field of view of the camera, degrees [the file's, else 40]")
      .between(0.1, 170.0)
      .group(group);
  app.add(
         "--focal-px", settings.focal_px,
         "Focal length in pixels of the depth, instead of --fov; the shorter side counts of pixels "
         "that are not square")
      .positive()
      .excludes("--fov")
      .group(group);
  app.add("--principal-px", settings.principal_px,
          "Where the view axis meets the image: X Y from the top left [the middle]")
      .count(2)
      .group(group);
  app.add("--pixel-aspect", settings.pixel_aspect,
          "Width of a px divided by its height; 2 for halves squeezed into one picture [1]")
      .between(0.01, 100.0)
      .group(group);
  app.addWord(
         "--projection", settings.projection, kProjections,
         "flat, or equirect: a panorama of all directions, depth along the ray, which is sent as a "
         "cube map [by an EXR's envmap, else flat]")
      .group(group);
  app.addWord("--camera-forward", settings.looks_along_minus_z, kForwards,
              "Which way the camera of an EXR's worldToCamera looks [+z]")
      .group(group);
}

}  // namespace

void addPlaneOptions(const usage::Command& app, InputSettings& settings) {
  const size_t count_before = app.options().size();
  addKindOptions(app, settings);
  addDepthOptions(app, settings);
  app.addWord("--transfer", settings.transfer, kTransfers,
              "How colour is stored: srgb or linear [by the file]")
      .group("Colour");
  app.addWord("--primaries", settings.primaries, kPrimaries,
              "What its primaries are: bt709, p3 or bt2020 [by the file, else bt709]")
      .group("Colour");
  app.addWord("--alpha", settings.alpha, kAlphas,
              "What alpha says: opaque, premultiplied or straight [by the file]")
      .group("Colour");
  app.addFlag("--flip-color", settings.flips_color, "Colour rows are stored upside down")
      .group("Colour");
  app.addWord("--tone-map", settings.tone_map, kToneMaps,
              "Of linear colour, how light brighter than white is shown: clip, filmic (a film's "
              "shoulder "
              "and toe) or agx (bright colours go to white) [a manifest's, else clip]")
      .group("Colour");
  addCameraOptions(app, settings);
  const std::vector<usage::Option> options = app.options();
  for (size_t i = count_before; i < options.size(); ++i) {
    const std::string name = options[i].name();
    options[i].onGiven([&settings, name] { settings.given.insert(name); });
  }
}

}  // namespace viewloom::cli
