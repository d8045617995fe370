# SPDX-License-Identifier: Apache-2.0
# The client builds where there is no Vulkan: configures it alone and reads what its build would run.
# cmake -D SOURCE=... -D BINARY=... -D NINJA=... -P client_alone.cmake
execute_process(
  COMMAND ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${BINARY} -DCMAKE_MAKE_PROGRAM=${NINJA}
    -DVIEWLOOM_SERVER=OFF -DVIEWLOOM_TESTS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_Vulkan=ON
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NINJA} -C ${BINARY} -t commands viewloom
  OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)

string(REGEX MATCH "[^ \n]*(libvulkan|glslangValidator|server/(gpu|structure|trace|pipeline)/)[^ \n]*"
  needs_device "${commands}")
if(needs_device)
  message(FATAL_ERROR "the client alone would build or link ${needs_device}")
endif()
# CMake takes the name of a library that no folder makes for one of the system's.
string(REGEX MATCH "-lviewloom_[a-z_]+" missing "${commands}")
if(missing)
  message(FATAL_ERROR "the client alone links ${missing}, which only the server builds")
endif()
