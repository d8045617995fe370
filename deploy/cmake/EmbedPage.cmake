# SPDX-License-Identifier: Apache-2.0
# cmake -D OUTPUT=x.cpp -D FOLDER=client/web -D "FILES=a.html b.js /elsewhere/c.h" -P EmbedPage.cmake:
# text files as C++ raw strings, for server/web/page_assets.h; all by their names alone.
set(html "text/html; charset=utf-8")
set(css "text/css; charset=utf-8")
set(js "text/javascript; charset=utf-8")
set(svg "image/svg+xml")
set(h "text/plain; charset=utf-8")

separate_arguments(FILES)
foreach(name IN LISTS FILES)
  cmake_path(ABSOLUTE_PATH name BASE_DIRECTORY ${FOLDER} OUTPUT_VARIABLE file)
  file(READ ${file} text)
  file(SHA256 ${file} digest)
  string(SUBSTRING ${digest} 0 16 tag)
  string(REGEX REPLACE ".*\\." "" extension ${name})
  cmake_path(GET file FILENAME base)
  set(path /${base})
  if(name STREQUAL "index.html")
    set(path /)
  endif()
  string(APPEND entries
    "    {\"${path}\", \"${${extension}}\", \"\\\"${tag}\\\"\", R\"viewloom(${text})viewloom\"},\n")
endforeach()

file(WRITE ${OUTPUT} "#include \"web/page_assets.h\"

namespace viewloom {
namespace {

constexpr PageAsset kAssets[] = {
${entries}};

}  // namespace

std::span<const PageAsset> pageAssets() { return kAssets; }

}  // namespace viewloom
")
