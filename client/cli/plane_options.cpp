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

constexpr char kInputHelp[] =
    "Program, sensor or network that made the files; the options below override it\n"
    "auto      EXR by its header, .heic as iphone, all others as plain\n"
    "plain     --depth and other options describe the files\n"
    "blender   EXR of Blender: multilayer, or of the File Output node\n"
    "unreal    EXR of the Movie Render Queue, with its camera; depth in cm\n"
    "nuke      EXR of Nuke; depth is inverse depth (1/Z)\n"
    "arnold, houdini\n"
    "          EXR, depth in scene units of any sign; 1e9 or more is infinite\n"
    "vray, redshift\n"
    "          the same; --depth-near and --depth-far give depth 0 and 1\n"
    "rgbd      one picture, half colour, half depth (default 0.67 to 2 m)\n"
    "2d+z      the same with disparity: --screen, --factor, --screen-code\n"
    "sensor    --depth in whole millimetres; 0 is no surface\n"
    "kitti     --depth in 1/256 m, with --baseline 1/256 px; 0 is no surface\n"
    "tum       --depth in 1/5000 m; 0 is no surface\n"
    "l515      --depth in 0.25 mm; 0 is no surface\n"
    "d405      --depth in 0.1 mm; 0 is no surface\n"
    "record3d  --depth in metres (floats) or millimetres; 0 is no surface\n"
    "openxr    --depth between --depth-near and --depth-far\n"
    "tmiv      --depth as normalised disparity (.png, .yuv), --camera JSON\n"
    "iphone    portrait photo (.heic), or --depth in 1/m (.exr, .pfm)\n"
    "relative  --depth of a network that estimates it (default 0.67 to 2 m)";
constexpr char kMeaningHelp[] =
    "Quantity that a depth sample measures\n"
    "planar     distance along the view axis (Z)\n"
    "ray        distance from the camera\n"
    "window     depth buffer value of 3D graphics, 0 to 1\n"
    "disparity  inverse depth (1/Z)";
constexpr char kPackingHelp[] =
    "Depth packed in colour, from 0 at black to 1 at white (--depth-scale: metres at white)\n"
    "rgb24    red is the lowest byte; white is 1000 m, as in CARLA\n"
    "bgr24    blue is the lowest byte; white is 1000 m\n"
    "rgba32   red is the highest byte, as in three.js since r163\n"
    "abgr32   alpha is the highest byte, as in three.js before r163\n"
    "rg16     red is the high byte\n"
    "gr16     green is the high byte\n"
    "float32  bytes of a float, blue lowest, as in TartanAir\n"
    "hue      colours of RealSense, between --depth-near and --depth-far";

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
  app.addWord("--input", settings.kind, inputKinds(), kInputHelp)
      .valueName("TOOL")
      .defaultText("auto")
      .group(group);
  app.add("--color-channels,--colour-channels", settings.color_channels,
          "EXR: colour as a layer (beauty) or as channels (R,G,B or R,G,B,A)")
      .valueName("NAMES")
      .defaultText("by their names")
      .group(group);
  app.add("--depth-channel", settings.depth_channel, "EXR: channel of depth")
      .valueName("NAME")
      .defaultText("by its name, such as Z or depth.Z")
      .group(group);
  app.addWord("--depth-side", settings.depth_side, kSides,
              "Input rgbd or 2d+z: side of the picture that holds depth")
      .defaultText("right")
      .group(group);
  app.addFlag("--black-near", settings.is_black_near,
              "Input rgbd, iphone or relative: black is near, not white")
      .group(group);
  app.add("--depth-white", settings.white_code,
          "Input rgbd, 2d+z, iphone, relative or openxr: code of white, such as 4095 for 12 bits, "
          "1 to 65535")
      .valueName("CODE")
      .between(1, 65535)
      .defaultText("255, or 65535 with 16 bits")
      .group(group);
  app.add("--screen", settings.screen_m, "Input 2d+z: distance of the screen")
      .valueName("METRES")
      .showDefault()
      .group(group);
  app.add("--factor", settings.factor, "Input 2d+z: strength of depth; 64 is 100 %")
      .showDefault()
      .group(group);
  app.add("--screen-code", settings.screen_code, "Input 2d+z: code of the screen, 0 to 255")
      .valueName("CODE")
      .between(0, 255)
      .showDefault()
      .group(group);
  app.add("--camera", settings.camera_file, "Input tmiv: camera parameters in JSON")
      .valueName("FILE")
      .group(group);
  app.add("--camera-name", settings.camera_name, "Input tmiv: name of the camera in --camera")
      .valueName("NAME")
      .defaultText("by the name of the depth file")
      .group(group);
}

void addDepthOptions(const usage::Command& app, InputSettings& settings) {
  const char* const group = "Depth";
  app.addWord("--depth-meaning", settings.depth_meaning, kMeanings, kMeaningHelp)
      .valueName("MEANING")
      .defaultText("by --input, else planar")
      .group(group);
  const auto addNumber = [&](const char* name, std::optional<double>& value, const char* text) {
    return app.add(name, value, text).group(group);
  };
  addNumber("--depth-scale,--scale", settings.depth_scale,
            "Metres per unit of a sample, 0.001 for millimetres; 1/m for disparity")
      .defaultText("by --input, else 1");
  addNumber("--depth-offset", settings.depth_offset,
            "Metres (disparity: 1/m) to add after the scale")
      .defaultText("by --input, else 0");
  addNumber("--depth-near", settings.near_m,
            "Distance of the nearest code or near plane; larger than far reverses window depth")
      .valueName("METRES");
  addNumber("--depth-far", settings.far_m, "Distance of the farthest code or far plane; may be inf")
      .valueName("METRES");
  addNumber("--no-surface-beyond", settings.no_surface_beyond_m,
            "Treat samples beyond this distance as no surface")
      .valueName("METRES");
  addNumber("--depth-min", settings.min_depth, "Window depth: smallest value, 0 to 1")
      .defaultText("0");
  addNumber("--depth-max", settings.max_depth, "Window depth: largest value, 0 to 1")
      .defaultText("1");
  addNumber("--depth-invalid", settings.depth_invalid,
            "Treat samples of exactly this value as no surface");
  app.addFlag("--depth-invalid-is-far", settings.depth_invalid_is_far,
              "Treat samples of --depth-invalid as infinitely far, like a sky")
      .group(group);
  app.addFlag("--depth-far-zero", settings.depth_far_zero,
              "Treat depth 0 as infinitely far: --depth-invalid 0 --depth-invalid-is-far")
      .group(group);
  addNumber("--baseline", settings.baseline_m,
            "Distance of two cameras; depth is their disparity in pixels (give --focal-px)")
      .valueName("METRES");
  app.addWord("--depth-packing", settings.depth_packing, packings(), kPackingHelp)
      .valueName("PACKING")
      .group(group);
  app.addFlag("--flip", settings.flips_depth,
              "Turn depth upside down, for files with rows from bottom to top")
      .group(group);
  app.add("--connection-tolerance", settings.connection_tolerance,
          "Largest step of inverse depth (1/Z, 1/m) within one surface; 0 measures it")
      .showDefault()
      .notNegative()
      .group(group);
}

void addCameraOptions(const usage::Command& app, InputSettings& settings) {
  const char* const group = "Camera";
  app.add("--fov", settings.fov_y_deg, "Vertical field of view of the camera, 0.1 to 170")
      .valueName("DEGREES")
      .defaultText("the file's, else 40")
      .between(0.1, 170.0)
      .group(group);
  app.add("--focal-px", settings.focal_px,
          "Focal length in pixels of the depth picture, instead of --fov; counts the shorter side "
          "of "
          "pixels that are not square")
      .valueName("PIXELS")
      .positive()
      .excludes("--fov")
      .group(group);
  app.add("--principal-px", settings.principal_px,
          "Pixel at which the view axis meets the image, from the top left")
      .count(2)
      .valueName("X Y")
      .defaultText("the middle")
      .group(group);
  app.add("--pixel-aspect", settings.pixel_aspect,
          "Width of a pixel divided by its height, 0.01 to 100; 2 for squeezed halves")
      .valueName("RATIO")
      .between(0.01, 100.0)
      .defaultText("1")
      .group(group);
  app.addWord(
         "--projection", settings.projection, kProjections,
         "Picture of a camera (flat) or panorama with ray depth (equirect), sent as a cube map")
      .defaultText("the file's, else flat")
      .group(group);
  app.addWord("--camera-forward", settings.looks_along_minus_z, kForwards,
              "Direction in which the camera of an EXR's worldToCamera matrix looks")
      .defaultText("+z")
      .group(group);
}

}  // namespace

void addPlaneOptions(const usage::Command& app, InputSettings& settings) {
  const size_t count_before = app.options().size();
  addKindOptions(app, settings);
  addDepthOptions(app, settings);
  app.addWord("--transfer", settings.transfer, kTransfers, "Transfer function of colour")
      .defaultText("the file's")
      .group("Colour");
  app.addWord("--primaries", settings.primaries, kPrimaries, "Primaries of colour")
      .defaultText("the file's, else bt709")
      .group("Colour");
  app.addWord("--alpha", settings.alpha, kAlphas,
              "Meaning of alpha: ignored (opaque), or colour is premultiplied or straight")
      .defaultText("the file's")
      .group("Colour");
  app.addFlag("--flip-color", settings.flips_color,
              "Turn colour upside down, for files with rows from bottom to top")
      .group("Colour");
  app.addWord("--tone-map", settings.tone_map, kToneMaps,
              "Curve for linear light brighter than white\n"
              "clip    cuts it off\n"
              "filmic  toe and shoulder of a film\n"
              "agx     turns bright colours to white")
      .defaultText("the manifest's, else clip")
      .group("Colour");
  addCameraOptions(app, settings);
  const std::vector<usage::Option> options = app.options();
  for (size_t i = count_before; i < options.size(); ++i) {
    const std::string name = options[i].name();
    options[i].onGiven([&settings, name] { settings.given.insert(name); });
  }
}

}  // namespace viewloom::cli
