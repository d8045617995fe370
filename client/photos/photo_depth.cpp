// SPDX-License-Identifier: Apache-2.0
#include "photos/photo_depth.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewloom::photos {
namespace {

// Apple's have a few thousand bytes, most of it tables of lens distortion.
constexpr size_t kXmpBytesMax = size_t{1} << 20;

std::string typeOf(const heif_image_handle* image) {
  const char* found = nullptr;
  if (heif_image_handle_get_auxiliary_type(image, &found).code != heif_error_Ok) return "";
  std::string type = found == nullptr ? "" : found;
  heif_image_handle_free_auxiliary_types(image, &found);
  return type;
}

// All that is XMP, one after the other.
std::string xmpOf(const heif_image_handle* image) {
  const int count = heif_image_handle_get_number_of_metadata_blocks(image, "mime");
  std::vector<heif_item_id> ids(static_cast<size_t>(std::max(count, 0)));
  heif_image_handle_get_list_of_metadata_block_IDs(image, "mime", ids.data(), count);
  std::string xmp;
  for (const heif_item_id id : ids) {
    const size_t size = heif_image_handle_get_metadata_size(image, id);
    const std::string content = heif_image_handle_get_metadata_content_type(image, id);
    if (content != "application/rdf+xml" || size > kXmpBytesMax - xmp.size()) continue;
    std::string block(size, '\0');
    if (heif_image_handle_get_metadata(image, id, block.data()).code == heif_error_Ok) xmp += block;
  }
  return xmp;
}

bool isDepthType(const std::string& type) {
  return type == "urn:mpeg:hevc:2015:auxid:2" ||
         type == "urn:mpeg:mpegB:cicp:systems:auxiliary:depth";
}

std::optional<CodeEnds> usable(double at_zero, double at_most) {
  if (!std::isfinite(at_zero) || !std::isfinite(at_most) || at_zero == at_most) {
    return std::nullopt;
  }
  return CodeEnds{at_zero, at_most};
}

// Reads the representation of a depth image: libheif finds none for other auxiliary images.
void readRepresentation(const heif_image_handle* image, heif_item_id id, PhotoDepth& depth) {
  const heif_depth_representation_info* found = nullptr;
  if (heif_image_handle_get_depth_image_representation_info(image, id, &found) == 0) return;
  const HeifOwned<const heif_depth_representation_info> info(found);
  const bool has_z = info->has_z_near != 0 && info->has_z_far != 0;
  const bool has_disparity = info->has_d_min != 0 && info->has_d_max != 0;
  switch (info->depth_representation_type) {
    case heif_depth_representation_type_uniform_Z:
      depth.quantity = CodeQuantity::kDistance;
      if (has_z) depth.ends = usable(info->z_near, info->z_far);
      break;
    case heif_depth_representation_type_uniform_inverse_Z:
    case heif_depth_representation_type_uniform_disparity:
      if (has_z) depth.ends = usable(1 / info->z_far, 1 / info->z_near);
      if (!has_z && has_disparity) depth.ends = usable(info->d_min, info->d_max);
      break;
    default:  // codes follow a table, which libheif leaves out
      break;
  }
  depth.origin = "depth representation";
}

}  // namespace

void readDepthXmp(const DepthXmp& xmp, PhotoDepth& depth) {
  depth.is_relative = xmp.accuracy == "relative";
  if (xmp.image_type == "depth") depth.quantity = CodeQuantity::kDistance;
  if (!xmp.float_min || !xmp.float_max) return;
  const double int_min = xmp.int_min.value_or(0), int_max = xmp.int_max.value_or(depth.code_max);
  const double per_code = (*xmp.float_max - *xmp.float_min) / (int_max - int_min);
  depth.ends = usable(*xmp.float_min - int_min * per_code,
                      *xmp.float_min + (depth.code_max - int_min) * per_code);
  depth.origin = "XMP";
}

FoundDepth findDepth(const heif_image_handle* photo) {
  FoundDepth found;
  const int count =
      heif_image_handle_get_number_of_auxiliary_images(photo, LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA);
  std::vector<heif_item_id> ids(static_cast<size_t>(std::max(count, 0)));
  heif_image_handle_get_list_of_auxiliary_image_IDs(photo, LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA,
                                                    ids.data(), count);
  for (const heif_item_id id : ids) {
    heif_image_handle* handle = nullptr;
    if (heif_image_handle_get_auxiliary_image_handle(photo, id, &handle).code != heif_error_Ok) {
      continue;
    }
    HeifOwned<heif_image_handle> image(handle);
    std::string type = typeOf(handle);
    const DepthXmp xmp = parseDepthXmp(xmpOf(handle));
    const bool is_depth =
        isDepthType(type) || xmp.image_type == "disparity" || xmp.image_type == "depth";
    if (!is_depth || found.image != nullptr) {
      found.other_types.push_back(std::move(type));
      continue;
    }
    const int bits = heif_image_handle_get_luma_bits_per_pixel(handle);
    found.depth = {.width_px = static_cast<uint32_t>(heif_image_handle_get_width(handle)),
                   .height_px = static_cast<uint32_t>(heif_image_handle_get_height(handle)),
                   .code_max = bits >= 8 && bits <= 16 ? (1U << bits) - 1 : 255,
                   .type = std::move(type)};
    readDepthXmp(xmp, found.depth);
    if (!found.depth.ends && isDepthType(found.depth.type)) {
      readRepresentation(handle, id, found.depth);
    }
    found.image = std::move(image);
  }
  return found;
}

}  // namespace viewloom::photos
