// SPDX-License-Identifier: Apache-2.0
// What libheif hands out, each freed by its owner.
#pragma once

#include <libheif/heif.h>

#include <memory>

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

}  // namespace viewloom::photos
