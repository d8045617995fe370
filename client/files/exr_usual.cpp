// SPDX-License-Identifier: Apache-2.0
#include "files/exr_usual.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "absl/strings/ascii.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "base/nearest_name.h"
#include "base/str_cat.h"
#include "files/exr_layer_names.h"

namespace viewloom::files {
namespace {

constexpr int kDerived = 10;  // added to the rank of filtered or normalised depth

struct ColorChoice {
  int rank = 0;
  const ExrLayer* layer = nullptr;
};

struct DepthChoice {
  int rank = 0;
  const ExrLayer* layer = nullptr;
  std::string name;
};

std::vector<ColorChoice> colorsIn(const std::vector<ExrLayer>& layers) {
  std::vector<ColorChoice> choices;
  for (const ExrLayer& layer : layers) {
    const std::optional<int> rank = pictureRank(layer.last);
    if (rank && !layer.color().empty()) choices.push_back({*rank, &layer});
  }
  // Grey never stands before colour.
  const auto is_grey = [](const ColorChoice& choice) { return choice.layer->color().size() == 1; };
  if (!std::all_of(choices.begin(), choices.end(), is_grey)) std::erase_if(choices, is_grey);
  // Layers of unknown names are the picture where there is one alone.
  const auto is_unknown = [](const ColorChoice& choice) { return choice.rank >= kUnknownPicture; };
  const auto unknown = std::count_if(choices.begin(), choices.end(), is_unknown);
  if (unknown > 1 || unknown != std::ptrdiff_t(choices.size())) {
    std::erase_if(choices, is_unknown);
  }
  return choices;
}

// Last words of channels in layers that are depth by their own name.
bool isOnlyValue(const std::string& base) {
  constexpr std::array<const char*, 6> kValues{"v", "r", "y", "x", "value", "distance"};
  return std::find(kValues.begin(), kValues.end(), base) != kValues.end();
}

std::vector<DepthChoice> depthsIn(const std::vector<ExrLayer>& layers) {
  std::vector<DepthChoice> choices;
  for (const ExrLayer& layer : layers) {
    const bool is_depth_layer = isDepthWord(layer.last);
    for (const std::string& base : layer.order) {
      const bool is_vector = base == "z" && layer.hasVectors();
      const bool is_named = isDepthWord(base) && !is_vector;
      if (!is_named && !(is_depth_layer && isOnlyValue(base))) continue;
      int rank = base == "z" && layer.path.empty() ? 0 : is_depth_layer ? 1 : is_named ? 2 : 3;
      if (isDerivedDepth(layer.last) || isDerivedDepth(base)) rank += kDerived;
      choices.push_back({rank, &layer, layer.channels.at(base)});
    }
  }
  return choices;
}

// The view's own name, or the default one.
std::string viewOr(const ExrDescription& description, const std::string& view) {
  return view.empty() ? defaultExrView(description) : view;
}

// Name of the channel of a layer that was named for its depth; "" = none.
std::string depthIn(const ExrLayer& layer) {
  if (layer.order.size() == 1) return layer.channels.begin()->second;
  for (const std::string& base : layer.order) {
    if (isDepthWord(base) || isOnlyValue(base)) return layer.channels.at(base);
  }
  return "";
}

std::vector<std::string> depthLayerNames(const std::vector<ExrLayer>& layers) {
  std::vector<std::string> names;
  for (const ExrLayer& layer : layers) {
    if (!layer.path.empty() && !depthIn(layer).empty()) names.push_back(layer.path);
  }
  return names;
}

std::vector<std::string> colorLayerNames(const std::vector<ExrLayer>& layers) {
  std::vector<std::string> names;
  for (const ExrLayer& layer : layers) {
    if (!layer.color().empty()) names.push_back(layer.path.empty() ? "R,G,B" : layer.path);
  }
  return names;
}

// "; did you mean "Depth.Z"?" by `names` and the channels of the file, or nothing.
std::string suggestion(const ExrDescription& description, std::string_view word,
                       std::vector<std::string> names) {
  for (const ExrDescribedPart& part : description.parts) {
    for (const ExrDescribedChannel& channel : part.channels) names.push_back(channel.name);
  }
  const std::string meant = didYouMean(word, names);
  return meant.empty() ? "" : strCat("; ", meant);
}

// The channel's name as the file has it; "" = none.
std::string nameInFile(const ExrDescription& description, const std::string& wanted) {
  std::string similar;
  for (const ExrDescribedPart& part : description.parts) {
    for (const ExrDescribedChannel& channel : part.channels) {
      if (channel.name == wanted) return channel.name;
      if (lowered(channel.name) == lowered(wanted)) similar = channel.name;
    }
  }
  return similar;
}

// A layer by its path, else by the last word of it.
const ExrLayer* findLayer(const std::vector<ExrLayer>& layers, const std::string& wanted) {
  const std::string name = lowered(wanted);
  for (const ExrLayer& layer : layers) {
    if (lowered(layer.path) == name) return &layer;
  }
  for (const ExrLayer& layer : layers) {
    if (lowered(layer.last) == name) return &layer;
  }
  return nullptr;
}

}  // namespace

ExrViewChannels usualExrChannels(const ExrDescription& description, const std::string& view) {
  const std::vector<ExrLayer> layers = exrLayersOf(description, viewOr(description, view));
  const std::vector<ColorChoice> colors = colorsIn(layers);
  const std::vector<DepthChoice> depths = depthsIn(layers);
  ExrViewChannels channels;
  // Layers of the same parent belong together, as Blender's passes.
  using Cost = std::tuple<int, bool, int>;
  std::optional<Cost> best;
  const auto take = [&](const ColorChoice* color, const DepthChoice* depth) {
    const bool is_apart =
        color != nullptr && depth != nullptr && color->layer->parent != depth->layer->parent;
    const Cost cost{color == nullptr ? 0 : color->rank, is_apart, depth ? depth->rank : 0};
    if (best && *best <= cost) return;
    best = cost;
    if (color != nullptr) channels.color = color->layer->color();
    if (depth != nullptr) channels.depth = {depth->name};
  };
  for (size_t i = 0; i < std::max<size_t>(colors.size(), 1); ++i) {
    for (size_t j = 0; j < std::max<size_t>(depths.size(), 1); ++j) {
      take(i < colors.size() ? &colors[i] : nullptr, j < depths.size() ? &depths[j] : nullptr);
    }
  }
  // Another view may have channels that the default view lacks.
  for (size_t i = 0; view.empty() && i < description.views.size(); ++i) {
    if (!channels.color.empty() && !channels.depth.empty()) break;
    const ExrViewChannels others = usualExrChannels(description, description.views[i]);
    if (channels.color.empty()) channels.color = others.color;
    if (channels.depth.empty()) channels.depth = others.depth;
  }
  return channels;
}

std::vector<std::string> onlyExrDepth(const ExrDescription& description, const std::string& view) {
  const std::vector<std::string> usual = usualExrChannels(description, view).depth;
  if (!usual.empty()) return usual;
  const std::vector<ExrLayer> layers = exrLayersOf(description, viewOr(description, view));
  std::vector<std::string> values;
  for (const ExrLayer& layer : layers) {
    for (const std::string& base : layer.order) {
      if (base != "a" && base != "alpha") values.push_back(layer.channels.at(base));
    }
  }
  if (values.size() == 1) return values;
  if (values.size() != 3 || layers.empty()) return {};
  const std::vector<std::string> color = layers.front().color();
  if (color.size() < 3 || layers.front().channels.contains("ry")) return {};
  return {color[0], color[1], color[2]};
}

absl::StatusOr<std::vector<std::string>> namedExrColor(const ExrDescription& description,
                                                       const std::string& view,
                                                       const std::string& wanted) {
  const std::vector<ExrLayer> layers = exrLayersOf(description, viewOr(description, view));
  std::vector<std::string> names;
  std::string unknown;  // the first word that is no channel
  for (const auto given : absl::StrSplit(wanted, ',')) {
    const std::string word(absl::StripAsciiWhitespace(given));
    const std::string name = nameInFile(description, word);
    if (!name.empty()) names.push_back(name);
    if (name.empty() && unknown.empty()) unknown = word;
  }
  const auto asked = 1 + std::count(wanted.begin(), wanted.end(), ',');
  const bool is_list = asked == 3 || asked == 4;
  if (is_list && names.size() == size_t(asked)) return names;
  if (asked == 1) {
    const ExrLayer* const layer = findLayer(layers, wanted);
    if (layer != nullptr && !layer->color().empty()) return layer->color();
    if (names.size() == 1) return names;
  }
  const std::vector<std::string> layer_names = colorLayerNames(layers);
  return absl::InvalidArgumentError(strCat(
      "--color-channels ", wanted, ": accepted are a layer with colour (",
      absl::StrJoin(layer_names, ", "),
      "), one channel for grey, or three or four channels as R,G,B,A; the file has ",
      listExrChannels(description),
      suggestion(description, unknown, asked == 1 ? layer_names : std::vector<std::string>{})));
}

absl::StatusOr<std::vector<std::string>> namedExrDepth(const ExrDescription& description,
                                                       const std::string& view,
                                                       const std::string& wanted) {
  const std::string name = nameInFile(description, wanted);
  if (!name.empty()) return std::vector<std::string>{name};
  const std::vector<ExrLayer> layers = exrLayersOf(description, viewOr(description, view));
  if (const ExrLayer* const layer = findLayer(layers, wanted)) {
    const std::string depth = depthIn(*layer);
    if (!depth.empty()) return std::vector<std::string>{depth};
  }
  return absl::InvalidArgumentError(strCat(
      "--depth-channel ", wanted, ": accepted is a channel of the file, which has ",
      listExrChannels(description), suggestion(description, wanted, depthLayerNames(layers))));
}

absl::StatusOr<std::string> exrView(const ExrDescription& description, const std::string& view) {
  const std::string found = viewOr(description, view);
  if (!exrLayersOf(description, found).empty() || view.empty()) return found;
  const std::string meant = didYouMean(view, description.views);
  return absl::InvalidArgumentError(strCat(
      "has no view ", view,
      description.views.empty() ? ""
                                : strCat("; accepted are ", absl::StrJoin(description.views, ", ")),
      "; its channels are ", listExrChannels(description), meant.empty() ? "" : "; ", meant));
}

bool hasPositionsAlone(const ExrDescription& description) {
  const std::vector<ExrLayer> layers = exrLayersOf(description, viewOr(description, ""));
  const auto is_vector = [](const ExrLayer& layer) { return layer.hasVectors(); };
  return colorsIn(layers).empty() && std::any_of(layers.begin(), layers.end(), is_vector);
}

}  // namespace viewloom::files
