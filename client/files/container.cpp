// SPDX-License-Identifier: Apache-2.0
#include "files/container.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/foreign_file.h"

namespace viewloom::files {
namespace {

using std::string_view_literals::operator""sv;

constexpr size_t kHeadBytes = 64;

struct Extension {
  const char* name;
  Container container;
};

constexpr std::array<Extension, 21> kExtensions{
    {{".exr", Container::kExr},   {".png", Container::kPng},   {".jpg", Container::kJpeg},
     {".jpeg", Container::kJpeg}, {".mpo", Container::kJpeg},  {".pfm", Container::kPfm},
     {".pgm", Container::kPnm},   {".ppm", Container::kPnm},   {".pnm", Container::kPnm},
     {".npy", Container::kNpy},   {".tif", Container::kTiff},  {".tiff", Container::kTiff},
     {".webp", Container::kWebp}, {".bmp", Container::kBmp},   {".dib", Container::kBmp},
     {".dpt", Container::kDpt},   {".heic", Container::kHeic}, {".heif", Container::kHeic},
     {".hif", Container::kHeic},  {".yuv", Container::kYuv},   {".jpe", Container::kJpeg}}};

std::string headOf(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "";
  std::string head(kHeadBytes, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return head;
}

bool isSpace(char c) {
  return absl::ascii_isspace(static_cast<unsigned char>(c));
}

bool isHeic(std::string_view head) {
  if (head.substr(4, 4) != "ftyp") return false;
  const std::string_view brand = head.substr(8, 4);
  for (const std::string_view its : {"heic"sv, "heix"sv, "heim"sv, "heis"sv, "mif1"sv, "msf1"sv}) {
    if (brand == its) return head.find("avif") == std::string_view::npos;
  }
  return false;
}

Container containerOfHead(std::string head) {
  head.resize(kHeadBytes);
  const auto begins = [&](std::string_view with) { return head.starts_with(with); };
  if (begins("\x76\x2f\x31\x01"sv)) return Container::kExr;
  if (begins("\x89PNG"sv)) return Container::kPng;
  if (begins("\xff\xd8\xff"sv)) return Container::kJpeg;
  if (begins("\x93NUMPY"sv)) return Container::kNpy;
  if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv)) {
    return Container::kTiff;
  }
  if (begins("RIFF"sv) && head.substr(8, 4) == "WEBP") return Container::kWebp;
  if (begins("PIEH"sv)) return Container::kDpt;
  if (begins("BM"sv) && head.substr(6, 4) == "\0\0\0\0"sv) return Container::kBmp;
  if (head[0] == 'P' && (isSpace(head[2]) || head[2] == '#')) {
    if (head[1] == 'F' || head[1] == 'f') return Container::kPfm;
    if (head[1] >= '1' && head[1] <= '6') return Container::kPnm;
  }
  return isHeic(head) ? Container::kHeic : Container::kUnknown;
}

}  // namespace

Container containerOfName(const std::filesystem::path& path) {
  for (const Extension& known : kExtensions) {
    if (hasExtension(path, known.name)) return known.container;
  }
  return Container::kUnknown;
}

const char* nameOf(Container container) {
  constexpr std::array<const char*, 13> kNames{"unknown", "OpenEXR", "PNG",  "JPEG", "PFM",
                                               "PNM",     "NPY",     "TIFF", "WebP", "BMP",
                                               "DPT",     "HEIC",    "YUV"};
  return kNames[static_cast<size_t>(container)];
}

std::string extensionOf(const std::filesystem::path& path) {
  return absl::AsciiStrToLower(path.extension().string());
}

bool hasExtension(const std::filesystem::path& path, std::string_view extension) {
  return extensionOf(path) == extension;
}

Container containerOf(const std::filesystem::path& path) {
  // Raw video has no header: its first bytes may be anything.
  if (hasExtension(path, ".yuv")) return Container::kYuv;
  const std::string head = headOf(path);
  const Container container = containerOfHead(head);
  if (container != Container::kUnknown) return container;
  return foreignKind(head, path) ? Container::kUnknown : containerOfName(path);
}

absl::Status checkPictureFile(const std::filesystem::path& path) {
  VIEWLOOM_RETURN_IF_ERROR(checkFile(path));
  if (containerOf(path) != Container::kUnknown) return absl::OkStatus();
  if (const auto foreign = foreignKind(headOf(path), path)) {
    return refuseFile(path.string(),
                      strCat("is ", foreign->what, ", not a picture; ", foreign->remedy));
  }
  return refuseFile(path.string(), strCat("is no picture of a known kind; accepted are ",
                                          kPictureKinds, ": export it as one of them"));
}

}  // namespace viewloom::files
