// SPDX-License-Identifier: Apache-2.0
#include "cli/option_trial.h"

#include <google/protobuf/util/json_util.h>

#include <filesystem>
#include <set>
#include <utility>

#include "base/str_cat.h"
#include "cli/plane_options.h"
#include "inputs/depth_format.h"

namespace viewloom::cli {
namespace {

// Remedies that fields of a manifest can express.
const std::set<std::string> kOfManifests{"--depth-meaning",
                                         "--depth-scale",
                                         "--depth-offset",
                                         "--depth-near",
                                         "--depth-far",
                                         "--depth-min",
                                         "--depth-max",
                                         "--depth-invalid",
                                         "--depth-far-zero",
                                         "--alpha",
                                         "--depth-invalid-is-far",
                                         "--flip"};

// Settings that were given, with the options after them. Nothing when they contradict each other.
std::optional<inputs::InputSettings> withOptions(inputs::InputSettings settings,
                                                 const std::string& options) {
  const usage::CommandLine app;
  addPlaneOptions(app, settings);
  return app.parse(options) ? std::optional(settings) : std::nullopt;
}

v1::DepthFormat depthOf(const inputs::InputSettings& settings, const v1::DepthFormat& format) {
  return inputs::withSettings(format, settings);
}

std::string json(const google::protobuf::Message& message) {
  std::string text;
  const auto written = google::protobuf::util::MessageToJsonString(message, &text);
  return written.ok() ? text : "";
}

}  // namespace

std::optional<files::LoadedFrame> OptionTrial::readManifest(
    const inputs::InputSettings& settings) const {
  for (const std::string& option : settings.given) {
    if (!kOfManifests.contains(option)) return std::nullopt;
  }
  const std::filesystem::path path = files_.manifest;
  absl::StatusOr<v1::FrameManifest> manifest = files::readFrameManifest(path);
  if (!manifest.ok()) return std::nullopt;
  for (v1::SourceFiles& source : *manifest->mutable_sources()) {
    for (v1::LayerFiles& layer : *source.mutable_layers()) {
      v1::DepthFormat& format = *layer.mutable_depth()->mutable_depth();
      format = depthOf(settings, format);
      if (settings.given.contains("--flip")) layer.mutable_depth()->set_flip(settings.flips_depth);
      if (settings.alpha != v1::ALPHA_MODE_UNSPECIFIED) {
        layer.mutable_color()->set_alpha(settings.alpha);
      }
    }
  }
  absl::StatusOr<files::LoadedFrame> frame = files::loadFrame(*manifest, path.parent_path());
  if (!frame.ok()) return std::nullopt;
  return *std::move(frame);
}

std::optional<files::LoadedFrame> OptionTrial::read(const std::string& options) const {
  const bool is_manifest = !files_.manifest.empty();
  const auto settings =
      withOptions(is_manifest ? inputs::InputSettings() : options_.input, options);
  if (!settings) return std::nullopt;
  if (is_manifest) return readManifest(*settings);
  LoaderOptions tried = options_;
  tried.input = *settings;
  absl::StatusOr<LoadedFiles> loaded = FrameLoader(tried).load(files_);
  if (!loaded.ok()) return std::nullopt;
  return std::move(loaded->frame);
}

std::string OptionTrial::spoken(const std::string& options) const {
  if (files_.manifest.empty()) return options == "--flip=false" ? "without --flip" : options;
  const auto settings = withOptions({}, options);
  if (!settings) return options;
  if (settings->alpha != v1::ALPHA_MODE_UNSPECIFIED) {
    return strCat("\"alpha\": \"", v1::AlphaMode_Name(settings->alpha), "\" in \"color\"");
  }
  if (settings->given.contains("--flip")) {
    return strCat("\"flip\": ", settings->flips_depth ? "true" : "false", " in \"depth\"");
  }
  return strCat(json(depthOf(*settings, {})), " in \"depth\"");
}

void tryRemedies(const OptionTrial& trial, std::vector<inspect::SourceInspection>& sources) {
  for (size_t source = 0; source < sources.size(); ++source) {
    std::vector<inspect::LayerInspection>& layers = sources[source].layers;
    for (size_t layer = 0; layer < layers.size(); ++layer) {
      for (inspect::Suspicion& suspicion : layers[layer].suspicions) {
        suspicion.remedy = inspect::remedyFor(suspicion, layers[layer], {source, layer}, trial);
      }
    }
  }
}

}  // namespace viewloom::cli
