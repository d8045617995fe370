// SPDX-License-Identifier: Apache-2.0
#include "unit/photos/written_photo.h"

#include <fstream>
#include <memory>
#include <stdexcept>

// Leaks that the sanitizer ignores: x265 3.5 leaks memory of each encoder. Reading uses none.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libx265";
}

namespace viewloom::test {
namespace {

struct Free {
  void operator()(heif_context* its) const { heif_context_free(its); }
  void operator()(heif_encoder* its) const { heif_encoder_release(its); }
  void operator()(heif_image* its) const { heif_image_release(its); }
  void operator()(heif_image_handle* its) const { heif_image_handle_release(its); }
  void operator()(heif_encoding_options* its) const { heif_encoding_options_free(its); }
  void operator()(heif_color_profile_nclx* its) const { heif_nclx_color_profile_free(its); }
};
template <typename Type>
using Owned = std::unique_ptr<Type, Free>;

void check(const heif_error& error) {
  if (error.code != heif_error_Ok) throw std::runtime_error(error.message);
}

Owned<heif_image> makeImage(uint32_t width_px, uint32_t height_px, heif_colorspace space,
                            heif_chroma chroma) {
  heif_image* made = nullptr;
  check(heif_image_create(static_cast<int>(width_px), static_cast<int>(height_px), space, chroma,
                          &made));
  return Owned<heif_image>(made);
}

void setProfiles(const WrittenPhoto& photo, heif_image* image) {
  const Owned<heif_color_profile_nclx> nclx(heif_nclx_color_profile_alloc());
  nclx->color_primaries = static_cast<heif_color_primaries>(photo.nclx_primaries);
  nclx->transfer_characteristics = heif_transfer_characteristic_IEC_61966_2_1;
  nclx->matrix_coefficients = heif_matrix_coefficients_ITU_R_BT_601_6;
  nclx->full_range_flag = 1;
  check(heif_image_set_nclx_color_profile(image, nclx.get()));
  if (photo.icc.empty()) return;
  check(heif_image_set_raw_color_profile(image, "prof", photo.icc.data(), photo.icc.size()));
}

Owned<heif_image> colorImage(const WrittenPhoto& photo) {
  Owned<heif_image> image =
      makeImage(photo.width_px, photo.height_px, heif_colorspace_RGB, heif_chroma_interleaved_RGB);
  check(heif_image_add_plane(image.get(), heif_channel_interleaved,
                             static_cast<int>(photo.width_px), static_cast<int>(photo.height_px),
                             8));
  int stride = 0;
  uint8_t* const rows = heif_image_get_plane(image.get(), heif_channel_interleaved, &stride);
  for (uint32_t y = 0; y < photo.height_px; ++y) {
    for (uint32_t x = 0; x < photo.width_px; ++x) {
      const std::array<uint8_t, 3> rgb = photo.color(x, y);
      std::copy(rgb.begin(), rgb.end(), rows + size_t{y} * static_cast<size_t>(stride) + 3 * x);
    }
  }
  setProfiles(photo, image.get());
  return image;
}

Owned<heif_image> secondImage(const WrittenPhoto& photo) {
  Owned<heif_image> image = makeImage(photo.second_width_px, photo.second_height_px,
                                      heif_colorspace_monochrome, heif_chroma_monochrome);
  check(heif_image_add_plane(image.get(), heif_channel_Y, static_cast<int>(photo.second_width_px),
                             static_cast<int>(photo.second_height_px), photo.second_bits));
  int stride = 0;
  uint8_t* const rows = heif_image_get_plane(image.get(), heif_channel_Y, &stride);
  const size_t sample_bytes = photo.second_bits == 8 ? 1 : 2;
  for (uint32_t y = 0; y < photo.second_height_px; ++y) {
    for (uint32_t x = 0; x < photo.second_width_px; ++x) {
      const uint16_t code = photo.code(x, y);
      uint8_t* const sample = rows + size_t{y} * static_cast<size_t>(stride) + x * sample_bytes;
      sample[0] = static_cast<uint8_t>(code);
      if (sample_bytes == 2) sample[1] = static_cast<uint8_t>(code >> 8);
    }
  }
  return image;
}

class PhotoEncoder {
 public:
  explicit PhotoEncoder(const WrittenPhoto& photo)
      : context_(heif_context_alloc()), options_(heif_encoding_options_alloc()) {
    heif_encoder* found = nullptr;
    check(heif_context_get_encoder_for_format(context_.get(), heif_compression_HEVC, &found));
    encoder_.reset(found);
    check(heif_encoder_set_lossless(found, 1));
    check(heif_encoder_set_parameter_string(found, "chroma", "420"));
    check(heif_encoder_set_parameter_string(found, "preset", "ultrafast"));
    options_->macOS_compatibility_workaround_no_nclx_profile = 0;
    options_->save_two_colr_boxes_when_ICC_and_nclx_available = 0;
    options_->image_orientation = photo.orientation;
  }

  Owned<heif_image_handle> add(const heif_image* image) {
    heif_image_handle* handle = nullptr;
    check(
        heif_context_encode_image(context_.get(), image, encoder_.get(), options_.get(), &handle));
    return Owned<heif_image_handle>(handle);
  }
  void addExif(const heif_image_handle* image, uint16_t focal_35mm) {
    // Big endian: a directory that leads to Exif's, which has the one entry.
    Bytes tiff{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 0x87, 0x69, 0, 4, 0, 0, 0, 1,
               0,   0,   0, 26, 0, 0, 0, 0, 0, 1, 0xA4, 0x05, 0, 3, 0, 0, 0, 1};
    tiff.push_back(static_cast<uint8_t>(focal_35mm >> 8));
    tiff.push_back(static_cast<uint8_t>(focal_35mm));
    tiff.resize(tiff.size() + 6);
    check(heif_context_add_exif_metadata(context_.get(), image, tiff.data(),
                                         static_cast<int>(tiff.size())));
  }
  void addXmp(const heif_image_handle* image, const std::string& xmp) {
    check(heif_context_add_XMP_metadata(context_.get(), image, xmp.data(),
                                        static_cast<int>(xmp.size())));
  }
  std::vector<heif_item_id> imageIds() const {
    std::vector<heif_item_id> ids(2);
    const int count = heif_context_get_list_of_top_level_image_IDs(context_.get(), ids.data(), 2);
    ids.resize(static_cast<size_t>(count));
    return ids;
  }
  Bytes file() {
    Bytes bytes;
    heif_writer writer{.writer_api_version = 1, .write = &append};
    check(heif_context_write(context_.get(), &writer, &bytes));
    return bytes;
  }

 private:
  static heif_error append(heif_context*, const void* data, size_t size, void* bytes) {
    const auto* const first = static_cast<const uint8_t*>(data);
    static_cast<Bytes*>(bytes)->insert(static_cast<Bytes*>(bytes)->end(), first, first + size);
    return {heif_error_Ok, heif_suberror_Unspecified, ""};
  }

  Owned<heif_context> context_;
  Owned<heif_encoding_options> options_;
  Owned<heif_encoder> encoder_;
};

}  // namespace

std::array<uint8_t, 3> blockColor(uint32_t x, uint32_t y) {
  const uint32_t column = x / 16 % 4, row = y / 16 % 3;
  return {static_cast<uint8_t>(40 + 60 * column), static_cast<uint8_t>(200 - 50 * row),
          static_cast<uint8_t>(30 + 25 * column + 40 * row)};
}

uint16_t secondCode(uint32_t x, uint32_t y) {
  return static_cast<uint16_t>((8 * x + 3 * y) % 256);
}

WrittenPhoto portrait() {
  WrittenPhoto photo;
  photo.color = blockColor;
  photo.code = secondCode;
  photo.focal_35mm = 26;
  // Display P3, as Apple's profile states it.
  photo.icc = iccProfile(
      {{{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}}});
  photo.xmp = appleXmp("disparity", "0.25", "1.525");
  return photo;
}

Bytes encodePhoto(const WrittenPhoto& photo) {
  PhotoEncoder encoder(photo);
  const Owned<heif_image_handle> color = encoder.add(colorImage(photo).get());
  if (photo.focal_35mm > 0) encoder.addExif(color.get(), photo.focal_35mm);
  if (!photo.has_second) return encoder.file();
  const Owned<heif_image_handle> second = encoder.add(secondImage(photo).get());
  if (!photo.xmp.empty()) encoder.addXmp(second.get(), photo.xmp);
  const std::vector<heif_item_id> ids = encoder.imageIds();
  return withAuxiliary(encoder.file(), {.item = ids.at(1),
                                        .of_item = ids.at(0),
                                        .type = photo.second_type,
                                        .subtypes = photo.subtypes});
}

void writeBytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void writePhoto(const std::filesystem::path& path, const WrittenPhoto& photo) {
  writeBytes(path, encodePhoto(photo));
}

}  // namespace viewloom::test
