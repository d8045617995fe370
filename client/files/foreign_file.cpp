// SPDX-License-Identifier: Apache-2.0
#include "files/foreign_file.h"

#include <array>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"

namespace viewloom::files {
namespace {

using std::string_view_literals::operator""sv;

enum class Family { kVideo, kModel, kPicture, kArchive, kText, kManifest, kRecording };

struct Signature {
  size_t offset;
  std::string_view bytes;
  Family family;
  const char* what;
};

constexpr std::array kSignatures{
    Signature{0, "\x1a\x45\xdf\xa3"sv, Family::kVideo, "a video (WebM or MKV)"},
    Signature{8, "AVI "sv, Family::kVideo, "a video (AVI)"},
    Signature{0, "\0\0\x01\xba"sv, Family::kVideo, "a video (MPEG)"},
    Signature{0, "\0\0\x01\xb3"sv, Family::kVideo, "a video (MPEG)"},
    Signature{0, "FLV\x01"sv, Family::kVideo, "a video (FLV)"},
    Signature{0, "\x30\x26\xb2\x75\x8e\x66"sv, Family::kVideo, "a video (WMV)"},
    Signature{0, "YUV4MPEG2"sv, Family::kVideo, "a video (Y4M)"},
    Signature{4, "ftypavif"sv, Family::kPicture, "an AVIF"},
    Signature{4, "ftypavis"sv, Family::kPicture, "an AVIF"},
    Signature{4, "ftypcrx "sv, Family::kPicture, "a camera's raw file (CR3)"},
    Signature{4, "ftyp"sv, Family::kVideo, "a video (MP4 or MOV)"},
    Signature{4, "moov"sv, Family::kVideo, "a video (MOV)"},
    Signature{4, "mdat"sv, Family::kVideo, "a video (MOV)"},
    Signature{4, "wide"sv, Family::kVideo, "a video (MOV)"},
    Signature{0, "GIF8"sv, Family::kPicture, "a GIF"},
    Signature{0, "8BPS"sv, Family::kPicture, "a Photoshop document"},
    Signature{0, "gimp xcf"sv, Family::kPicture, "a GIMP document"},
    Signature{0, "\0\0\0\x0cJXL "sv, Family::kPicture, "a JPEG XL"},
    Signature{0, "\xff\x0a"sv, Family::kPicture, "a JPEG XL"},
    Signature{0, "\0\0\0\x0cjP  "sv, Family::kPicture, "a JPEG 2000"},
    Signature{0, "\xff\x4f\xff\x51"sv, Family::kPicture, "a JPEG 2000"},
    Signature{0, "#?RADIANCE"sv, Family::kPicture, "a Radiance HDR"},
    Signature{0, "#?RGBE"sv, Family::kPicture, "a Radiance HDR"},
    Signature{0, "DDS "sv, Family::kPicture, "a DDS texture"},
    Signature{0, "\xabKTX "sv, Family::kPicture, "a KTX texture"},
    Signature{0, "qoif"sv, Family::kPicture, "a QOI"},
    Signature{0, "\0\0\x01\0"sv, Family::kPicture, "an icon (ICO)"},
    Signature{0, "P7\n"sv, Family::kPicture, "a PAM"},
    Signature{0, "%PDF"sv, Family::kPicture, "a PDF"},
    Signature{0, "glTF"sv, Family::kModel, "a 3D model (glTF)"},
    Signature{0, "ply\n"sv, Family::kModel, "a 3D model (PLY)"},
    Signature{0, "ply\r"sv, Family::kModel, "a 3D model (PLY)"},
    Signature{0, "BLENDER"sv, Family::kModel, "a Blender scene"},
    Signature{0, "Kaydara FBX"sv, Family::kModel, "a 3D model (FBX)"},
    Signature{0, "; FBX"sv, Family::kModel, "a 3D model (FBX)"},
    Signature{0, "PXR-USDC"sv, Family::kModel, "a 3D scene (USD)"},
    Signature{0, "#usda"sv, Family::kModel, "a 3D scene (USD)"},
    Signature{0, "solid "sv, Family::kModel, "a 3D model (STL)"},
    Signature{0, "VIEWLOOM"sv, Family::kRecording, "a recording of viewloom"}};

struct ForeignName {
  const char* extension;
  Family family;
  const char* what;
};

// Formats that begin as they like, or inside an archive.
constexpr std::array kForeignNames{
    ForeignName{".obj", Family::kModel, "a 3D model (OBJ)"},
    ForeignName{".stl", Family::kModel, "a 3D model (STL)"},
    ForeignName{".gltf", Family::kModel, "a 3D model (glTF)"},
    ForeignName{".glb", Family::kModel, "a 3D model (glTF)"},
    ForeignName{".ply", Family::kModel, "a 3D model (PLY)"},
    ForeignName{".fbx", Family::kModel, "a 3D model (FBX)"},
    ForeignName{".blend", Family::kModel, "a Blender scene"},
    ForeignName{".usd", Family::kModel, "a 3D scene (USD)"},
    ForeignName{".usda", Family::kModel, "a 3D scene (USD)"},
    ForeignName{".usdc", Family::kModel, "a 3D scene (USD)"},
    ForeignName{".usdz", Family::kModel, "a 3D scene (USD)"},
    ForeignName{".dae", Family::kModel, "a 3D model (COLLADA)"},
    ForeignName{".3ds", Family::kModel, "a 3D model (3DS)"},
    ForeignName{".splat", Family::kModel, "a 3D model (Gaussian splats)"},
    ForeignName{".r3d", Family::kArchive, "a Record3D archive"},
    ForeignName{".npz", Family::kArchive, "an archive of arrays (NPZ)"},
    ForeignName{".bag", Family::kVideo, "a recording of a sensor (BAG)"},
    ForeignName{".mp4", Family::kVideo, "a video (MP4)"},
    ForeignName{".m4v", Family::kVideo, "a video (MP4)"},
    ForeignName{".mov", Family::kVideo, "a video (MOV)"},
    ForeignName{".mkv", Family::kVideo, "a video (MKV)"},
    ForeignName{".webm", Family::kVideo, "a video (WebM)"},
    ForeignName{".avi", Family::kVideo, "a video (AVI)"},
    ForeignName{".mpg", Family::kVideo, "a video (MPEG)"},
    ForeignName{".mpeg", Family::kVideo, "a video (MPEG)"},
    ForeignName{".ts", Family::kVideo, "a video (MPEG)"},
    ForeignName{".wmv", Family::kVideo, "a video (WMV)"},
    ForeignName{".gif", Family::kPicture, "a GIF"},
    ForeignName{".avif", Family::kPicture, "an AVIF"},
    ForeignName{".psd", Family::kPicture, "a Photoshop document"},
    ForeignName{".tga", Family::kPicture, "a TGA"},
    ForeignName{".hdr", Family::kPicture, "a Radiance HDR"},
    ForeignName{".svg", Family::kPicture, "a drawing (SVG)"}};

constexpr std::array kArchives{
    Signature{0, "PK\x03\x04"sv, Family::kArchive, "an archive (ZIP)"},
    Signature{0, "\x1f\x8b"sv, Family::kArchive, "an archive (gzip)"},
    Signature{0, "\x28\xb5\x2f\xfd"sv, Family::kArchive, "an archive (zstd)"},
    Signature{0, "7z\xbc\xaf"sv, Family::kArchive, "an archive (7z)"},
    Signature{0, "\x89HDF"sv, Family::kArchive, "an HDF5 file"},
    Signature{0, "MATLAB 5.0"sv, Family::kArchive, "a MATLAB file"},
    Signature{0, "{"sv, Family::kManifest, "JSON"},
    Signature{0, "<"sv, Family::kText, "a text (XML or HTML)"},
    Signature{0, "version https://git-lfs"sv, Family::kText, "a pointer of Git LFS"}};

std::string remedyFor(const Signature& found, const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  switch (found.family) {
    case Family::kVideo:
      return strCat("write its frames as pictures first: ffmpeg -i \"", name, "\" frame_%04d.png");
    case Family::kModel:
      return "render it with a depth pass first, for instance in Blender as multilayer EXR "
             "(Combined and Z)";
    case Family::kPicture:
      return "export it as PNG or EXR first";
    case Family::kArchive:
      return "take out the pictures first, or save the array as NPY (numpy.save)";
    case Family::kManifest:
      return "a manifest is given with --manifest FILE, a camera with --camera FILE";
    case Family::kRecording:
      return "a recording of frames is given with publish --replay FILE";
    case Family::kText:
      return "fetch the picture itself";
  }
  return "";
}

template <size_t kCount>
const Signature* find(const std::array<Signature, kCount>& signatures, std::string_view head) {
  for (const Signature& its : signatures) {
    if (head.size() >= its.offset + its.bytes.size() &&
        head.substr(its.offset, its.bytes.size()) == its.bytes) {
      return &its;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<ForeignKind> foreignKind(std::string_view head, const std::filesystem::path& path) {
  const auto kindOf = [&](const Signature& found) {
    return ForeignKind{found.what, remedyFor(found, path)};
  };
  // Cut short within its brand, a file of boxes is what its name says.
  constexpr size_t kBrandEnd = 12;
  const bool has_brand = head.size() >= kBrandEnd;
  const Signature* const known = find(kSignatures, head);
  if (known != nullptr && (known->bytes != "ftyp" || has_brand)) return kindOf(*known);
  const std::string extension = absl::AsciiStrToLower(path.extension().string());
  for (const ForeignName& name : kForeignNames) {
    if (extension == name.extension) return kindOf({0, {}, name.family, name.what});
  }
  const Signature* const found = find(kArchives, head);
  return found == nullptr ? std::nullopt : std::optional(kindOf(*found));
}

}  // namespace viewloom::files
