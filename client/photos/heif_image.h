// SPDX-License-Identifier: Apache-2.0
// Things that libheif hands out, each freed by its owner, and the colour profile of an image.
#pragma once

#include <libheif/heif.h>

#include <memory>
#include <optional>

#include "viewloom/v1/frame.pb.h"

namespace viewloom::photos {

struct FreeHeif {
  void operator()(heif_context* context) const { heif_context_free(context); }
  void operator()(const heif_image_handle* handle) const { heif_image_handle_release(handle); }
  void operator()(const heif_image* image) const { heif_image_release(image); }
  void operator()(heif_decoding_options* options) const { heif_decoding_options_free(options); }
  void operator()(heif_color_profile_nclx* profile) const { heif_nclx_color_profile_free(profile); }
  void operator()(const heif_depth_representation_info* info) const {
    heif_depth_representation_info_free(info);
  }
};

template <typename Type>
using HeifOwned = std::unique_ptr<Type, FreeHeif>;

// Which primaries a photo's colour profile means.
struct ColorProfile {
  bool is_stated = false;
  std::optional<v1::ColorPrimaries> primaries;  // stated ones, where the wire knows them
  bool is_hdr = false;                          // stated as PQ or HLG
};

// ICC where the photo has one, else nclx; an nclx that leaves its primaries open states nothing.
ColorProfile colorProfileOf(const heif_image_handle* image);

}  // namespace viewloom::photos
