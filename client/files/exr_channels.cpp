// SPDX-License-Identifier: Apache-2.0
#include "files/exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

namespace viewloom::files {
namespace {

bool isFlat(const Imf::Header& header) {
  return !header.hasType() || !Imf::isDeepData(header.type());
}

std::optional<ExrChannel> channelOfPart(const Imf::MultiPartInputFile& file, int part,
                                        const std::string& name) {
  const Imf::Header& header = file.header(part);
  if (!isFlat(header)) return std::nullopt;
  const Imf::Channel* channel = header.channels().findChannel(name);
  if (channel == nullptr) return std::nullopt;
  return ExrChannel{.part = part,
                    .name = name,
                    .type = channel->type,
                    .x_sampling = channel->xSampling,
                    .y_sampling = channel->ySampling};
}

// Whether the channels without a prefix of this part belong to what is called `prefix`.
bool partIsCalled(const Imf::Header& header, const std::string& prefix) {
  if (header.hasName() && header.name() == prefix) return true;
  if (header.hasView() && header.view() == prefix) return true;
  if (!Imf::hasMultiView(header)) return false;
  const Imf::StringVector& views = Imf::multiView(header);
  return !views.empty() && views.front() == prefix;
}

}  // namespace

std::optional<ExrChannel> findExrChannel(const Imf::MultiPartInputFile& file,
                                         const std::string& name) {
  for (int part = 0; part < file.parts(); ++part) {
    if (auto channel = channelOfPart(file, part, name)) return channel;
  }
  for (size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1)) {
    for (int part = 0; part < file.parts(); ++part) {
      if (!partIsCalled(file.header(part), name.substr(0, dot))) continue;
      if (auto channel = channelOfPart(file, part, name.substr(dot + 1))) return channel;
    }
  }
  return std::nullopt;
}

}  // namespace viewloom::files
