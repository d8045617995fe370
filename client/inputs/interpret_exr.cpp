// SPDX-License-Identifier: Apache-2.0
#include "inputs/interpret_exr.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_join.h"
#include "base/str_cat.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "files/exr_image.h"
#include "files/file_bytes.h"
#include "inputs/exr_header_facts.h"
#include "inputs/exr_tool.h"

namespace viewloom::inputs {
namespace {

// Blender writes this where a ray hits nothing.
constexpr double kBlenderNothing = 1e10;
constexpr double kMetresPerCentimetre = 0.01;

using Names = std::vector<std::string>;

// A description with what it takes to speak of its file.
struct Described {
  std::string file;
  files::ExrDescription description;
  std::string view;  // as the file calls it
};

absl::StatusOr<std::optional<Described>> describe(const std::string& file,
                                                  const std::string& view) {
  if (!files::isExr(file)) return std::optional<Described>();
  absl::StatusOr<files::ExrDescription> description = files::describeExr(file);
  if (!description.ok()) return description.status();
  const absl::StatusOr<std::string> found = files::exrView(*description, view);
  if (!found.ok() && !description->isDeep()) {
    return files::refuseFile(file, std::string(found.status().message()));
  }
  return std::optional(Described{file, *std::move(description), found.value_or("")});
}

const files::ExrDescribedPart& partOf(const files::ExrDescription& description,
                                      const Names& names) {
  for (const files::ExrDescribedPart& part : description.parts) {
    for (const files::ExrDescribedChannel& channel : part.channels) {
      if (!names.empty() && channel.name == names.front()) return part;
    }
  }
  return description.parts.front();
}

void setNames(const Names& names, v1::PlaneFile& plane) {
  plane.mutable_channels()->Assign(names.begin(), names.end());
}

class ExrInterpreter {
 public:
  // `color`, `depth`: the files that are EXR files, at least one; `depth` of a file of its own.
  ExrInterpreter(const InputSettings& settings, const std::optional<Described>& color,
                 const std::optional<Described>& depth, bool has_depth_file, Interpretation& result)
      : settings_(settings),
        color_(color ? &*color : nullptr),
        depth_(depth ? &*depth : nullptr),
        has_depth_file_(has_depth_file),
        result_(result) {}

  absl::Status interpret() {
    const Described& header = color_ != nullptr ? *color_ : *depth_;
    readHeaderFacts(settings_, header.description, result_);
    VIEWLOOM_RETURN_IF_ERROR(findChannels());
    settleWindows();
    return readHeaderCamera(settings_, header.file, header.description, result_);
  }

 private:
  v1::PlaneFile& colorPlane() { return *result_.source.mutable_layers(0)->mutable_color(); }
  v1::PlaneFile& depthPlane() { return *result_.source.mutable_layers(0)->mutable_depth(); }
  // The file that the depth is in; nullptr when that is no EXR file.
  const Described* depthFile() const { return has_depth_file_ ? depth_ : color_; }
  bool mayDetect() const { return settings_.kind == InputKind::kAuto; }

  absl::Status findChannels() {
    const Described* const depth_file = depthFile();
    if (color_ != nullptr) {
      found_.color = files::usualExrChannels(color_->description, color_->view).color;
    }
    if (depth_file != nullptr) {
      found_.depth = has_depth_file_
                         ? files::onlyExrDepth(depth_file->description, depth_file->view)
                         : files::usualExrChannels(color_->description, color_->view).depth;
    }
    VIEWLOOM_RETURN_IF_ERROR(findTool());
    VIEWLOOM_RETURN_IF_ERROR(takeNamed());
    askForNukeDepth();
    if (color_ != nullptr) setNames(found_.color, colorPlane());
    if (depth_file != nullptr) setNames(found_.depth, depthPlane());
    note();
    return absl::OkStatus();
  }

  absl::Status takeNamed() {
    if (!settings_.color_channels.empty() && color_ != nullptr) {
      absl::StatusOr<Names> names =
          files::namedExrColor(color_->description, color_->view, settings_.color_channels);
      if (!names.ok())
        return files::refuseFile(color_->file, std::string(names.status().message()));
      found_.color = *std::move(names);
    }
    const Described* const file = depthFile();
    if (!settings_.depth_channel.empty() && file != nullptr) {
      absl::StatusOr<Names> names =
          files::namedExrDepth(file->description, file->view, settings_.depth_channel);
      if (!names.ok()) return files::refuseFile(file->file, std::string(names.status().message()));
      found_.depth = *std::move(names);
    }
    return absl::OkStatus();
  }

  // Names of Blender and Unreal tell themselves; other tools say who they are.
  absl::Status findTool() {
    const bool may_be_unreal = result_.kind == InputKind::kUnreal || mayDetect();
    const bool is_world_depth =
        !found_.depth.empty() && found_.depth.front().ends_with("WorldDepth.R");
    if (color_ != nullptr && !has_depth_file_ && may_be_unreal) {
      if (const auto layers = unrealLayers(color_->description)) {
        found_ = {layers->color, {layers->depth}};
        setUnreal();
        return absl::OkStatus();
      }
    }
    if (may_be_unreal && has_depth_file_ && is_world_depth) {
      setUnreal();
      return absl::OkStatus();
    }
    if (color_ != nullptr && !has_depth_file_ && mayBeBlender()) {
      if (const auto layers = blenderLayers(color_->description, color_->view)) {
        found_ = {layers->color, {layers->depth}};
        setBlender();
        return absl::OkStatus();
      }
    }
    if (result_.kind == InputKind::kUnreal && !has_depth_file_ && settings_.depth_channel.empty()) {
      return files::refuseFile(color_->file,
                               "has no channel that ends in WorldDepth.R beside FinalImage's or "
                               "plain R, G, B; --input plain reads R, G, B and Z by any other "
                               "name, --color-channels and --depth-channel name them");
    }
    if (result_.kind == InputKind::kUnreal) setUnreal();
    if (mayDetect()) detectByHeader();
    if (result_.kind == InputKind::kBlender) setBlender();
    return absl::OkStatus();
  }

  bool mayBeBlender() const { return result_.kind == InputKind::kBlender || mayDetect(); }

  void detectByHeader() {
    const Described* const file = depthFile();
    if (file == nullptr || result_.kind != InputKind::kPlain) return;
    const auto tool = toolOf(file->description);
    // Values, without a colour, are V to Blender's File Output alone.
    const bool is_blender_value = !found_.depth.empty() && (found_.depth.front() == "V" ||
                                                            found_.depth.front().ends_with(".V"));
    if (tool) {
      result_.kind = *tool;
    } else if (is_blender_value) {
      result_.kind = InputKind::kBlender;
    }
  }

  // Other layers pass through Nuke as they came. A user who says what depth means is not asked.
  void askForNukeDepth() {
    const Described* const file = depthFile();
    const bool is_open = mayDetect() && result_.kind == InputKind::kPlain &&
                         settings_.depth_meaning == v1::DEPTH_MEANING_UNSPECIFIED;
    if (!is_open || file == nullptr || found_.depth.empty()) return;
    if (isOfNuke(file->description) && isDepthOfNuke(found_.depth.front())) {
      result_.nuke_channel = found_.depth.front();
    }
  }

  void setUnreal() {
    result_.kind = InputKind::kUnreal;
    depthPlane().mutable_depth()->set_scale(kMetresPerCentimetre);
  }

  void setBlender() {
    result_.kind = InputKind::kBlender;
    v1::DepthFormat& format = *depthPlane().mutable_depth();
    format.set_invalid_value(kBlenderNothing);
    format.set_invalid_is_far(true);
  }

  void note() {
    std::string note = strCat(nameOf(result_.kind), ": ");
    if (color_ != nullptr && !found_.color.empty()) {
      note += strCat("colour in ", absl::StrJoin(found_.color, ", "));
      const bool has_chroma = found_.color.size() > 2 && found_.color[1].ends_with("RY");
      if (has_chroma) note += strCat(" (luminance and chroma)");
    }
    if (depthFile() != nullptr && !found_.depth.empty()) {
      note += strCat(note.ends_with(": ") ? "" : ", ", "depth in ", found_.depth.front(),
                     found_.depth.size() > 1 ? ", which the other channels repeat" : "", meaning());
      const files::ExrDescribedPart& part = partOf(depthFile()->description, found_.depth);
      for (const files::ExrDescribedChannel& channel : part.channels) {
        if (channel.name == found_.depth.front() && channel.type == "uint") {
          note += strCat(" of whole numbers");
        }
      }
    }
    // The names that everybody expects are not worth a line.
    const bool is_usual = note == "plain: colour in R, G, B, depth in Z" ||
                          note == "plain: colour in R, G, B, A, depth in Z";
    if (!is_usual && !note.ends_with(": ")) result_.notes.push_back(std::move(note));
  }

  std::string meaning() const {
    switch (result_.kind) {
      case InputKind::kUnreal:
        return " in cm";
      case InputKind::kBlender:
        return " in scene units along the view axis (--depth-meaning ray for Cycles before 2.8)";
      case InputKind::kNuke:
        return " as 1/Z (--depth-meaning ray or planar for others)";
      case InputKind::kArnold:
      case InputKind::kVray:
      case InputKind::kRedshift:
      case InputKind::kHoudini:
        return " in scene units along the view axis (--depth-scale 0.01 for centimetres)";
      default:
        return "";
    }
  }

  void settleWindows() {
    const Described* const depth_file = depthFile();
    std::vector<ExrFrameWindows> windows;
    const auto take = [&windows](const Described* file, const Names& names) {
      if (file == nullptr) return;
      const files::ExrDescribedPart& part = partOf(file->description, names);
      windows.push_back({part.display, part.data});
    };
    take(color_, found_.color);
    take(depth_file, found_.depth);
    const bool has_overscan =
        std::any_of(windows.begin(), windows.end(), [](const ExrFrameWindows& its) {
          return !isSame(intersection(its.display, its.data), its.data);
        });
    if (windows.size() < 2 || !isSame(windows[0].display, windows[1].display)) {
      if (has_overscan) {
        result_.notes.push_back(
            "overscan is left out: colour and depth do not have the same display window");
      }
      return;
    }
    v1::ExrWindow window;
    settleWindow({windows[0].display, intersection(windows[0].data, windows[1].data)}, window,
                 result_);
    if (!window.has_size()) return;
    *colorPlane().mutable_window() = window;
    *depthPlane().mutable_window() = window;
  }

  const InputSettings& settings_;
  const Described* color_;
  const Described* depth_;
  const bool has_depth_file_;
  Interpretation& result_;
  files::ExrViewChannels found_;
};

}  // namespace

absl::Status interpretExr(const InputSettings& settings, const InputFiles& files,
                          Interpretation& result) {
  const auto color = describe(files.color, files.view);
  if (!color.ok()) return color.status();
  const auto depth = describe(files.depth, files.view);
  if (!depth.ok()) return depth.status();
  return ExrInterpreter(settings, *color, *depth, !files.depth.empty(), result).interpret();
}

}  // namespace viewloom::inputs
