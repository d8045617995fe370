// SPDX-License-Identifier: Apache-2.0
#include "files/exr_description.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <exception>

#include "base/str_cat.h"
#include "files/exr_open.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

std::string typeName(Imf::PixelType type) {
  return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

ExrWindow windowOf(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x, box.max.y};
}

ExrDescribedPart describePart(const Imf::Header& header, bool has_siblings) {
  ExrDescribedPart part;
  if (header.hasName()) part.name = header.name();
  if (header.hasView()) part.view = header.view();
  part.type = header.hasType()              ? header.type()
              : header.hasTileDescription() ? "tiledimage"
                                            : "scanlineimage";
  part.display = windowOf(header.displayWindow());
  part.data = windowOf(header.dataWindow());
  part.width_px = part.display.width();
  part.height_px = part.display.height();
  const std::string prefix = has_siblings && !part.name.empty() ? part.name + "." : "";
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const std::string name = it.name();
    part.channels.push_back(
        {.name = name.starts_with(prefix) ? name : prefix + name,
         .type = typeName(it.channel().type),
         .is_subsampled = it.channel().xSampling != 1 || it.channel().ySampling != 1});
  }
  return part;
}

std::optional<std::string> textOf(const Imf::Attribute& attribute) {
  if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
    return text->value();
  }
  if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
    return strCat(number->value());
  }
  if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
    return strCat(number->value());
  }
  if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
    return strCat(number->value());
  }
  return std::nullopt;
}

std::optional<ExrMatrix> matrixOf(const Imf::Header& header, const char* name) {
  ExrMatrix matrix;
  const auto take = [&matrix](const auto& value) {
    for (int i = 0; i < 16; ++i) matrix[static_cast<size_t>(i)] = value[i / 4][i % 4];
    return matrix;
  };
  if (const auto* f = header.findTypedAttribute<Imf::M44fAttribute>(name)) return take(f->value());
  if (const auto* d = header.findTypedAttribute<Imf::M44dAttribute>(name)) return take(d->value());
  return std::nullopt;
}

}  // namespace

bool ExrDescription::isDeep() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](const ExrDescribedPart& part) { return part.isDeep(); });
}

ExrDescription describeExr(const Imf::MultiPartInputFile& file) {
  ExrDescription description;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    description.parts.push_back(describePart(header, file.parts() > 1));
    if (header.hasView()) description.views.push_back(header.view());
  }
  const Imf::Header& first = file.header(0);
  if (Imf::hasMultiView(first)) description.views = Imf::multiView(first);
  for (auto it = first.begin(); it != first.end(); ++it) {
    if (auto text = textOf(it.attribute())) description.texts[it.name()] = *std::move(text);
  }
  description.world_to_camera = matrixOf(first, "worldToCamera");
  description.world_to_ndc = matrixOf(first, "worldToNDC");
  if (Imf::hasChromaticities(first)) description.chromaticities = Imf::chromaticities(first);
  description.pixel_aspect = double{first.pixelAspectRatio()};
  if (Imf::hasEnvmap(first)) {
    description.envmap =
        Imf::envmap(first) == Imf::ENVMAP_CUBE ? ExrEnvmap::kCube : ExrEnvmap::kLatLong;
  }
  return description;
}

absl::StatusOr<ExrDescription> describeExr(const std::filesystem::path& path) {
  const auto file = openExr(path);
  if (!file.ok()) return file.status();
  try {
    return describeExr(**file);
  } catch (const std::exception& error) {
    return absl::DataLossError(strCat(path.string(), ": ", error.what()));
  }
}

std::string listExrChannels(const ExrDescription& description) {
  std::string names;
  for (const ExrDescribedPart& part : description.parts) {
    for (const ExrDescribedChannel& channel : part.channels) {
      names += strCat(names.empty() ? "" : ", ", channel.name, part.isDeep() ? " (deep)" : "");
    }
  }
  return names;
}

}  // namespace viewloom::files
