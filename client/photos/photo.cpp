// SPDX-License-Identifier: Apache-2.0
#include "photos/photo.h"

#include <cstring>
#include <exception>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_join.h"
#include "base/str_cat.h"
#include "files/container.h"
#include "files/exif.h"
#include "files/file_bytes.h"
#include "files/icc_profile.h"
#include "files/jpeg_image.h"
#include "files/jpeg_segments.h"
#include "photos/jpeg_depth.h"

namespace viewloom::photos {
namespace {

// The largest photo that is read: phones write a few MB, 48 megapixels as much as 20.
constexpr uint64_t kPhotoBytesMax = uint64_t{256} << 20;

absl::Status refuseHeif(const std::string& name, const char* what, const std::string& why) {
  return files::refuseFile(name,
                           strCat(what, ": ", absl::StripAsciiWhitespace(why),
                                  "; copy it anew from where it was taken, unchanged (.heic)"));
}

std::optional<double> focalOf(const heif_image_handle* image) {
  heif_item_id id = 0;
  if (heif_image_handle_get_list_of_metadata_block_IDs(image, "Exif", &id, 1) != 1) return {};
  std::vector<uint8_t> item(heif_image_handle_get_metadata_size(image, id));
  if (heif_image_handle_get_metadata(image, id, item.data()).code != heif_error_Ok) return {};
  return files::focal35mm(files::tiffOfItem(item));
}

struct PlaneRequest {
  heif_colorspace space;
  heif_chroma chroma;
  heif_channel channel;
};

constexpr PlaneRequest kRgb{heif_colorspace_RGB, heif_chroma_interleaved_RGB,
                            heif_channel_interleaved};
// Stored form: colour of a depth image, if it has any, has no meaning.
constexpr PlaneRequest kLuma{heif_colorspace_undefined, heif_chroma_undefined, heif_channel_Y};

// Rows of one channel of a decoded image.
struct Rows {
  HeifOwned<heif_image> image;
  const uint8_t* first = nullptr;
  size_t stride_bytes = 0;
  int bits = 0;
};

absl::StatusOr<Rows> decodeImage(const std::string& name, const heif_image_handle* handle,
                                 const PlaneRequest& request) {
  const HeifOwned<heif_decoding_options> options(heif_decoding_options_alloc());
  options->convert_hdr_to_8bit = request.channel == heif_channel_interleaved;
  heif_image* decoded = nullptr;
  const heif_error error =
      heif_decode_image(handle, &decoded, request.space, request.chroma, options.get());
  Rows rows{.image = HeifOwned<heif_image>(decoded)};
  if (error.code != heif_error_Ok) return refuseHeif(name, "cannot be decoded", error.message);
  int stride_bytes = 0;
  heif_channel channel = request.channel;
  if (channel == heif_channel_Y && heif_image_has_channel(decoded, channel) == 0) {
    channel = heif_channel_G;  // tiles are put together as red, green and blue, all alike if grey
  }
  rows.first = heif_image_get_plane_readonly(decoded, channel, &stride_bytes);
  rows.stride_bytes = static_cast<size_t>(stride_bytes);
  rows.bits = heif_image_get_bits_per_pixel_range(decoded, channel);
  if (rows.first == nullptr) {
    return files::refuseFile(name, "has an image of an unknown kind; the file is damaged");
  }
  const int width_px = heif_image_get_width(decoded, channel);
  const int height_px = heif_image_get_height(decoded, channel);
  if (width_px != heif_image_handle_get_width(handle) ||
      height_px != heif_image_handle_get_height(handle)) {
    return files::refuseFile(
        name, strCat("says ", heif_image_handle_get_width(handle), "x",
                     heif_image_handle_get_height(handle), " px of an image of ", width_px, "x",
                     height_px, "; the file is damaged"));
  }
  return rows;
}

absl::StatusOr<Rows> decode(const std::string& name, const heif_image_handle* handle,
                            const PlaneRequest& request) {
  try {
    return decodeImage(name, handle, request);
  } catch (const std::exception& error) {
    return refuseHeif(name, "cannot be decoded", error.what());
  }
}

}  // namespace

bool isPhoto(const std::string& file) {
  const files::Container container = files::containerOf(file);
  if (container != files::Container::kJpeg) return container == files::Container::kHeic;
  const absl::StatusOr<std::vector<uint8_t>> bytes = files::readFileBytes(file, kPhotoBytesMax);
  return bytes.ok() && findJpegDepth(*bytes, files::readJpegSegments(*bytes)).has_value();
}

absl::StatusOr<Photo> Photo::open(const std::filesystem::path& path) {
  absl::StatusOr<std::vector<uint8_t>> bytes = files::readFileBytes(path, kPhotoBytesMax);
  if (!bytes.ok()) return bytes.status();
  Photo photo(path.string(), *std::move(bytes));
  if (files::containerOf(path) == files::Container::kJpeg) {
    VIEWLOOM_RETURN_IF_ERROR(photo.readJpeg());
    return photo;
  }
  try {
    VIEWLOOM_RETURN_IF_ERROR(photo.readBoxes());
    photo.describe();
  } catch (const std::exception& error) {  // libheif lets those of the standard library through
    return refuseHeif(photo.name_, "cannot be read", error.what());
  }
  const PhotoDescription& its = photo.description_;
  VIEWLOOM_RETURN_IF_ERROR(files::checkPlaneSize(photo.name_, its.width_px, its.height_px));
  if (its.depth) {
    VIEWLOOM_RETURN_IF_ERROR(
        files::checkPlaneSize(photo.name_, its.depth->width_px, its.depth->height_px));
  }
  return photo;
}

absl::Status Photo::readJpeg() {
  is_jpeg_ = true;
  const files::JpegSegments segments = files::readJpegSegments(bytes_);
  const absl::StatusOr<files::Picture> color = files::decodeJpeg(name_, bytes_);
  if (!color.ok()) return color.status();
  description_.width_px = color->width_px;
  description_.height_px = color->height_px;
  description_.profile = {.is_stated = !segments.icc.empty(),
                          .primaries = files::primariesOfIcc(segments.icc)};
  description_.focal_35mm = files::focal35mm(segments.exif);
  std::optional<JpegDepth> found = findJpegDepth(bytes_, segments);
  if (!found) return absl::OkStatus();
  absl::StatusOr<files::Picture> depth =
      decodeJpegDepth(name_, *found, files::orientationOf(segments.exif));
  if (!depth.ok()) return depth.status();
  jpeg_depth_ = *std::move(depth);
  description_.depth = std::move(found->depth);
  return absl::OkStatus();
}

absl::Status Photo::readBoxes() {
  context_.reset(heif_context_alloc());
  heif_context_set_maximum_image_size_limit(context_.get(), static_cast<int>(files::kSideMax_px));
  heif_error error = heif_context_read_from_memory_without_copy(context_.get(), bytes_.data(),
                                                                bytes_.size(), nullptr);
  if (error.code == heif_error_Ok) {
    heif_image_handle* primary = nullptr;
    error = heif_context_get_primary_image_handle(context_.get(), &primary);
    color_.reset(primary);
  }
  if (error.code == heif_error_Ok) return absl::OkStatus();
  return refuseHeif(name_, "is no HEIC that can be read, or is cut short", error.message);
}

void Photo::describe() {
  FoundDepth found = findDepth(color_.get());
  description_ = {.width_px = static_cast<uint32_t>(heif_image_handle_get_width(color_.get())),
                  .height_px = static_cast<uint32_t>(heif_image_handle_get_height(color_.get())),
                  .profile = colorProfileOf(color_.get()),
                  .focal_35mm = focalOf(color_.get()),
                  .other_types = std::move(found.other_types)};
  if (found.image != nullptr) description_.depth = std::move(found.depth);
  depth_ = std::move(found.image);
}

absl::Status Photo::requireDepth() const {
  if (depth_ != nullptr || jpeg_depth_) return absl::OkStatus();
  const std::string others =
      description_.other_types.empty()
          ? "no auxiliary image"
          : strCat("auxiliary images of ", absl::StrJoin(description_.other_types, ", "));
  return files::refuseFile(name_, strCat("has no depth: it holds ", others,
                                         "; take it in portrait mode, or give --depth FILE "
                                         "beside it"));
}

absl::StatusOr<files::PlaneImage> Photo::readColor() const {
  if (is_jpeg_) {
    absl::StatusOr<files::Picture> picture = files::decodeJpeg(name_, bytes_);
    if (!picture.ok()) return picture.status();
    return files::colorPlane(*std::move(picture), v1::COLOR_TRANSFER_UNSPECIFIED);
  }
  const absl::StatusOr<Rows> rows = decode(name_, color_.get(), kRgb);
  if (!rows.ok()) return rows.status();
  files::PlaneImage image{.width_px = description_.width_px,
                          .height_px = description_.height_px,
                          .encoding = v1::PLANE_ENCODING_RGB8};
  const size_t row_bytes = size_t{3} * image.width_px;
  image.bytes.resize(row_bytes * image.height_px);
  for (size_t y = 0; y < image.height_px; ++y) {
    std::memcpy(&image.bytes[y * row_bytes], rows->first + y * rows->stride_bytes, row_bytes);
  }
  return image;
}

absl::StatusOr<files::PlaneImage> Photo::readDepth() const {
  VIEWLOOM_RETURN_IF_ERROR(requireDepth());
  if (jpeg_depth_) return files::depthPlane(name_, *jpeg_depth_, false);
  const absl::StatusOr<Rows> rows = decode(name_, depth_.get(), kLuma);
  if (!rows.ok()) return rows.status();
  const PhotoDepth& depth = *description_.depth;
  files::PlaneImage image{.width_px = depth.width_px,
                          .height_px = depth.height_px,
                          .encoding = v1::PLANE_ENCODING_DEPTH_U16,
                          .code_max = depth.code_max};
  if (rows->bits < 8 || rows->bits > 16 || (1U << rows->bits) - 1 != depth.code_max) {
    return files::refuseFile(name_, strCat("has depth of ", rows->bits,
                                           " bits; accepted are 8 to 16, as it says itself"));
  }
  image.bytes.resize(size_t{2} * image.width_px * image.height_px);
  const size_t sample_bytes = rows->bits == 8 ? 1 : 2;
  for (size_t y = 0; y < image.height_px; ++y) {
    const uint8_t* const row = rows->first + y * rows->stride_bytes;
    for (size_t x = 0; x < image.width_px; ++x) {
      uint16_t code = 0;  // little endian, as this machine
      std::memcpy(&code, row + x * sample_bytes, sample_bytes);
      std::memcpy(&image.bytes[2 * (y * image.width_px + x)], &code, sizeof(code));
    }
  }
  return image;
}

}  // namespace viewloom::photos
