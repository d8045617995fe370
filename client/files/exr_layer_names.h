// SPDX-License-Identifier: Apache-2.0
// Names of OpenEXR channels taken apart, and what their words say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "files/exr_description.h"

namespace viewloom::files {

// A layer: channels of one part and view whose names differ in the last word alone.
struct ExrLayer {
  size_t part = 0;
  std::string path;    // "ViewLayer.Combined", without the view; "" = no prefix
  std::string parent;  // "ViewLayer"
  std::string last;    // "Combined"
  std::map<std::string, std::string> channels;  // lower-case last word to the name in the file
  std::vector<std::string> order;               // last words as in the file

  // Names of R, G, B and perhaps A, or red and so on, or Y, RY, BY; or of Y alone; else empty.
  std::vector<std::string> color() const;
  // X, Y and Z: positions or normals.
  bool hasVectors() const;
};

std::string lowered(std::string text);

// The view of channels that name none: the first part's, or the first of the file's list.
std::string defaultExrView(const ExrDescription& description);

// Layers of one view, of flat parts. `view`: as in the file.
std::vector<ExrLayer> exrLayersOf(const ExrDescription& description, const std::string& view);

// How surely the word says that the layer is the picture: 0 surest; nothing for words that say it
// is something else.
std::optional<int> pictureRank(const std::string& word);
inline constexpr int kUnknownPicture = 100;  // words that say neither

// "Z", "zdepth", "WorldDepth", "Pz".
bool isDepthWord(const std::string& word);
// "filtered", "normalised": depth that is no measure, or mixed at edges.
bool isDerivedDepth(const std::string& word);

}  // namespace viewloom::files
