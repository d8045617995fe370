# SPDX-License-Identifier: Apache-2.0
# cmake -DSPIRV=<file> -DNAME=<name> -DHEADER=<file> -P EmbedSpirv.cmake: writes a C++ header with the words of
# a SPIR-V module as the array <name>.
file(READ ${SPIRV} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REGEX REPLACE "(0x........,0x........,0x........,0x........,)" "\\1\n" lines "${words}")
file(WRITE ${HEADER} "#pragma once\n#include <cstdint>\nconst uint32_t ${NAME}[] = {\n${lines}};\n")
