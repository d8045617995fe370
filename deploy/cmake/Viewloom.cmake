# SPDX-License-Identifier: Apache-2.0
# The helpers every CMakeLists.txt of viewloom uses: one library per folder, one program per test file.

add_library(viewloom_options INTERFACE)
target_compile_options(viewloom_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wunused-result
  -Wno-missing-field-initializers)  # what a designated initialiser leaves out has its default

# Clang 14 does not see that a generic lambda calls a member of what it captures.
target_compile_options(viewloom_options INTERFACE
  $<$<CXX_COMPILER_ID:Clang>:-Wno-unused-lambda-capture>)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # Where std::string is inlined from precompiled headers, GCC 12 warns of accesses that nothing does. In
  # other headers of the system it keeps quiet.
  target_compile_options(viewloom_options INTERFACE
    -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
endif()

# Sources of a folder are compiled several at a time (a unity build): they share what their headers cost,
# which is most of what a small source costs. A change to one then compiles its neighbours too, so few are
# joined. Builds that prove that each source includes what it uses compile each alone.
set(VIEWLOOM_JOINED_SOURCES 1 CACHE STRING "How many sources of a folder are compiled at a time")
if(VIEWLOOM_JOINED_SOURCES GREATER 1)
  # GCC warns where a type of a joined source has a member of its unnamed namespace.
  target_compile_options(viewloom_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
function(viewloom_join_sources target)
  if(VIEWLOOM_JOINED_SOURCES GREATER 1)
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${VIEWLOOM_JOINED_SOURCES})
  endif()
endfunction()

# Options of folders that compute with vectors: one rounding per operation, on every kind of CPU. In
# a loop over whole vectors, GCC 12 for AVX-512 takes a deciding bool for the mask of their lanes.
# So it looks at the first lane alone (few_rays_test) where it converts branches of loops.
add_library(viewloom_kernel_options INTERFACE)
target_compile_options(viewloom_kernel_options INTERFACE
  -ffp-contract=off $<$<CXX_COMPILER_ID:GNU>:-fno-tree-loop-if-convert>)

set(VIEWLOOM_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them")
if(VIEWLOOM_SANITIZE)
  # Undefined behaviour ends the program, as a bad address does: a mere message fails no test.
  add_compile_options(-fsanitize=${VIEWLOOM_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${VIEWLOOM_SANITIZE})
endif()
if(VIEWLOOM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Headers of libraries are compiled once and reused (precompiled), never those of viewloom itself: what
# changes is compiled anew in each file that includes it. A set is what a group of folders includes:
#   common   the standard library, absl::StatusOr and GLM: all folders that name no other set
#   kernels  the same, for folders that compute with vectors
#   proto    and Protobuf: proto/
#   grpc     and gRPC: proto/
#   vulkan   and Vulkan-Hpp: server/engine/walk/gpu/
#   beast    and Boost.Beast: server/web/
#   gtest    and GoogleTest: tests/
# A file pays for its set whether it uses it or not: at the end of each file, GCC instantiates the
# templates that inline functions of precompiled headers name. An empty file takes 1.5 s of CPU time with
# common, 1.7 with proto, 2.2 to 3 with grpc and 5 with beast. Choose the smallest set that serves a file.
# Builds that prove that each file includes what it uses do without (CMAKE_DISABLE_PRECOMPILE_HEADERS).
set(viewloom_common_headers
  <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <cstddef> <cstdint> <filesystem>
  <functional> <map> <memory> <mutex> <optional> <set> <span> <string> <string_view> <thread>
  <unordered_map> <utility> <variant> <vector>
  <absl/status/status.h> <absl/status/statusor.h> <absl/strings/str_cat.h>
  <glm/common.hpp> <glm/geometric.hpp> <glm/vec2.hpp> <glm/vec3.hpp>)
# GCC takes precompiled headers only with the flags that they were compiled with, and some of what
# folders link asks for this one. Other flags, as -ffp-contract, it takes from the precompiled headers,
# whatever the file is compiled with: who has flags of their own needs a set of their own.
add_compile_options(-pthread)

# viewloom_precompile(<set> [HEADERS ...] [LINK ...]): what PRECOMPILED <set> of viewloom_add_library names.
function(viewloom_precompile set)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${set}_headers.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// All that this library has are its precompiled headers.\n")
  add_library(viewloom_${set}_headers OBJECT ${source})
  target_include_directories(viewloom_${set}_headers PRIVATE ${PROJECT_SOURCE_DIR}/server
    ${PROJECT_SOURCE_DIR}/server/engine/walk)
  target_link_libraries(viewloom_${set}_headers PRIVATE viewloom_options ${ARG_LINK})
  target_precompile_headers(viewloom_${set}_headers PRIVATE ${viewloom_common_headers} ${ARG_HEADERS})
endfunction()
viewloom_precompile(common)
viewloom_precompile(kernels LINK viewloom_kernel_options)

# viewloom_add_library(<folder> SOURCES ... HEADERS ... [LINK ...] [PRECOMPILED <set>]
#   [EXCEPT <set> <source> ...] [VECTORS]): static library viewloom_<folder>. Includes are written from
# server/core, server/engine/walk, server/engine, server/ and client/. EXCEPT: the sources that take another
# set of precompiled headers. VECTORS: it computes with vectors (viewloom_kernel_options).
function(viewloom_add_library folder)
  cmake_parse_arguments(ARG "VECTORS" "PRECOMPILED" "SOURCES;HEADERS;LINK;EXCEPT" ${ARGN})
  set(target viewloom_${folder})
  if(ARG_VECTORS)
    set(ARG_PRECOMPILED kernels)
  elseif(NOT ARG_PRECOMPILED)
    set(ARG_PRECOMPILED common)
  endif()
  set(roots ${PROJECT_SOURCE_DIR}/server/core ${PROJECT_SOURCE_DIR}/server/engine/walk
    ${PROJECT_SOURCE_DIR}/server/engine ${PROJECT_SOURCE_DIR}/server ${PROJECT_SOURCE_DIR}/client)
  set(own_sources ${ARG_SOURCES})
  if(ARG_EXCEPT)
    list(POP_FRONT ARG_EXCEPT other_set)
    list(REMOVE_ITEM own_sources ${ARG_EXCEPT})
    add_library(${target}_${other_set} OBJECT ${ARG_EXCEPT})
    target_include_directories(${target}_${other_set} PRIVATE ${roots})
    target_link_libraries(${target}_${other_set} PRIVATE viewloom_options ${ARG_LINK})
    target_precompile_headers(${target}_${other_set} REUSE_FROM viewloom_${other_set}_headers)
    if(NOT other_set STREQUAL "beast")
      viewloom_join_sources(${target}_${other_set})
    endif()
    list(APPEND own_sources $<TARGET_OBJECTS:${target}_${other_set}>)
  endif()
  if(ARG_SOURCES)
    add_library(${target} STATIC ${own_sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE viewloom_options)
    if(ARG_VECTORS)
      target_link_libraries(${target} PRIVATE viewloom_kernel_options)
    endif()
    target_precompile_headers(${target} REUSE_FROM viewloom_${ARG_PRECOMPILED}_headers)
    if(NOT ARG_VECTORS AND NOT ARG_PRECOMPILED STREQUAL "beast")
      viewloom_join_sources(${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  # x.cpp includes x.h first and so proves that it stands alone; the headers without a source are
  # proven by the target all_verify_interface_header_sets.
  set(paired ${ARG_HEADERS})
  set(lone ${ARG_HEADERS})
  foreach(header IN LISTS ARG_HEADERS)
    string(REGEX REPLACE "[.]h$" ".cpp" source ${header})
    if(source IN_LIST ARG_SOURCES)
      list(REMOVE_ITEM lone ${header})
    else()
      list(REMOVE_ITEM paired ${header})
    endif()
  endforeach()
  target_include_directories(${target} ${scope} ${roots})
  # A file set takes no root within another.
  foreach(root IN LISTS roots ITEMS ${PROJECT_SOURCE_DIR}/tests)
    cmake_path(IS_PREFIX root ${CMAKE_CURRENT_SOURCE_DIR} is_root)
    if(is_root)
      set(base ${root})
      break()
    endif()
  endforeach()
  target_sources(${target} ${scope}
    FILE_SET HEADERS BASE_DIRS ${base} FILES ${paired}
    FILE_SET lone_headers TYPE HEADERS BASE_DIRS ${base} FILES ${lone})
  set_target_properties(${target} PROPERTIES
    VERIFY_INTERFACE_HEADER_SETS ON INTERFACE_HEADER_SETS_TO_VERIFY lone_headers)
  target_link_libraries(${target} ${scope} ${ARG_LINK})
endfunction()

# viewloom_add_test(<name> LABEL <unit|gpu|e2e|...> SOURCES ... [LINK ...] [TIMEOUT <seconds>] [COST <seconds>]
#   [WHOLE]): one GoogleTest program. Each case is a test of ctest, called <name>.<suite>.<case>. WHOLE: all
# cases together are one, called <name>, because they share what takes longer to make than they take
# (compiled kernels of a device). The timeout is for hung tests; slow machines are busy with others, too.
# COST: ctest begins with the longest, so that none is left alone at the end.
include(GoogleTest)
function(viewloom_add_test name)
  cmake_parse_arguments(ARG "WHOLE" "LABEL;TIMEOUT;COST" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 900)
  endif()
  if(NOT ARG_COST)
    set(ARG_COST 60)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  if(ARG_LABEL STREQUAL "unit")
    add_dependencies(unit_tests ${name})
    if(VIEWLOOM_CORE_TESTS)
      add_dependencies(core_tests ${name})
    endif()
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE viewloom_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM viewloom_gtest_headers)
  viewloom_join_sources(${name})
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT}
      COST ${ARG_COST})
  else()
    gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 120
      PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT})
  endif()
endfunction()

# viewloom_add_fixture(<name> SOURCES ... [LINK ...]): library viewloom_test_<name> of what several
# tests share. Includes are written from tests/.
function(viewloom_add_fixture name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(viewloom_test_${name} STATIC ${ARG_SOURCES})
  target_include_directories(viewloom_test_${name} PUBLIC ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(viewloom_test_${name} PRIVATE viewloom_options PUBLIC ${ARG_LINK})
  target_precompile_headers(viewloom_test_${name} REUSE_FROM viewloom_common_headers)
  viewloom_join_sources(viewloom_test_${name})
endfunction()
