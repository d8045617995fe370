// SPDX-License-Identifier: Apache-2.0
#include "files/exr_open.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTestFile.h>

#include <array>
#include <cstdint>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>

#include "base/str_cat.h"
#include "files/exr_header.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// Limit for the sides of a data window or a tile: far beyond any display window, without a chunk
// table of gigabytes.
constexpr int kDataSideMax_px = 32768;
// OpenEXR takes memory for an attribute before it reads it. Lists of names (cryptomatte) have some
// hundred kilobytes, previews less.
constexpr uint64_t kAttributeBytesMax = uint64_t{16} << 20;
constexpr uint64_t kHeaderBytesMax = uint64_t{64} << 20;  // of all parts together

// Walks over the attributes of all headers and believes none of them.
class AttributeWalk {
 public:
  explicit AttributeWalk(const std::filesystem::path& path)
      : path_(path.string()), in_(path, std::ios::binary) {}

  absl::Status check() {
    takeNumber();  // the magic number, which OpenEXR checks
    const bool is_multi_part = (takeNumber() & kExrMultiPartFlag) != 0;
    do {
      bool is_empty = true;
      VIEWLOOM_RETURN_IF_ERROR(checkPart(is_empty));
      if (is_empty) return absl::OkStatus();
    } while (is_multi_part);
    return absl::OkStatus();
  }

 private:
  absl::Status checkPart(bool& is_empty) {
    for (;;) {
      const std::string name = takeText();
      if (in_ && name.empty()) return absl::OkStatus();
      takeText();  // its type
      const uint32_t size = takeNumber();
      is_empty = false;
      header_bytes_ += size;
      if (!in_) return refuse("the file ends in the header, or a name in it has no end");
      if (size > kAttributeBytesMax || header_bytes_ > kHeaderBytesMax) {
        return refuse(strCat("attribute ", name, " says it has ", size,
                             " bytes; accepted are up to ", kAttributeBytesMax, ", and ",
                             kHeaderBytesMax, " in all"));
      }
      in_.ignore(size);
      if (in_.gcount() != std::streamsize{size}) {
        return refuse(strCat("attribute ", name, " has ", size, " bytes, more than follow"));
      }
    }
  }

  absl::Status refuse(const std::string& problem) const {
    return refuseFile(path_, strCat("is no EXR file to be read: ", problem));
  }

  uint32_t takeNumber() {
    std::array<unsigned char, 4> bytes{};
    in_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    uint32_t number = 0;
    for (size_t i = 0; i < bytes.size(); ++i) number |= uint32_t{bytes[i]} << (8 * i);
    return number;
  }

  // Names have at most 255 letters; longer ones fail.
  std::string takeText() {
    std::array<char, 257> text{};
    in_.getline(text.data(), text.size(), '\0');
    header_bytes_ += static_cast<uint64_t>(in_.gcount());
    return text.data();
  }

  std::string path_;
  std::ifstream in_;
  uint64_t header_bytes_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Imf::MultiPartInputFile>> openExr(
    const std::filesystem::path& path) {
  static std::once_flag limits_set;
  std::call_once(limits_set, [] {
    Imf::Header::setMaxImageSize(kDataSideMax_px, kDataSideMax_px);
    Imf::Header::setMaxTileSize(kDataSideMax_px, kDataSideMax_px);
  });
  VIEWLOOM_RETURN_IF_ERROR(checkFile(path));
  if (!Imf::isOpenExrFile(path.c_str())) {
    return refuseFile(path.string(),
                      "is no EXR file to be read: it begins with other bytes than one does");
  }
  VIEWLOOM_RETURN_IF_ERROR(AttributeWalk(path).check());
  try {
    return std::make_unique<Imf::MultiPartInputFile>(path.c_str());
  } catch (const std::exception& error) {
    return refuseFile(path.string(), strCat("is no EXR file to be read: ", error.what()));
  }
}

}  // namespace viewloom::files
