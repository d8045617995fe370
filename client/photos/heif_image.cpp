// SPDX-License-Identifier: Apache-2.0
#include "photos/heif_image.h"

#include <vector>

#include "files/icc_profile.h"

namespace viewloom::photos {
namespace {

// Code points of ITU-T H.273.
std::optional<v1::ColorPrimaries> primariesOfNclx(int code) {
  switch (code) {
    case heif_color_primaries_ITU_R_BT_709_5:
      return v1::COLOR_PRIMARIES_BT709;
    case heif_color_primaries_ITU_R_BT_2020_2_and_2100_0:
      return v1::COLOR_PRIMARIES_BT2020;
    case heif_color_primaries_SMPTE_EG_432_1:
      return v1::COLOR_PRIMARIES_DISPLAY_P3;
    default:
      return std::nullopt;
  }
}

ColorProfile nclxProfileOf(const heif_image_handle* image) {
  heif_color_profile_nclx* found = nullptr;
  if (heif_image_handle_get_nclx_color_profile(image, &found).code != heif_error_Ok) return {};
  const HeifOwned<heif_color_profile_nclx> nclx(found);
  if (nclx == nullptr) return {};
  const int transfer = nclx->transfer_characteristics;
  return {.is_stated = nclx->color_primaries != heif_color_primaries_unspecified,
          .primaries = primariesOfNclx(nclx->color_primaries),
          .is_hdr = transfer == heif_transfer_characteristic_ITU_R_BT_2100_0_PQ ||
                    transfer == heif_transfer_characteristic_ITU_R_BT_2100_0_HLG};
}

}  // namespace

ColorProfile colorProfileOf(const heif_image_handle* image) {
  const ColorProfile nclx = nclxProfileOf(image);
  std::vector<uint8_t> icc(heif_image_handle_get_raw_color_profile_size(image));
  if (icc.empty() ||
      heif_image_handle_get_raw_color_profile(image, icc.data()).code != heif_error_Ok) {
    return nclx;
  }
  return {.is_stated = true, .primaries = files::primariesOfIcc(icc), .is_hdr = nclx.is_hdr};
}

}  // namespace viewloom::photos
