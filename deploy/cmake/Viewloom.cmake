# SPDX-License-Identifier: Apache-2.0
# The helpers every CMakeLists.txt of viewloom uses: one library per folder, one program per test file.

add_library(viewloom_options INTERFACE)
target_compile_options(viewloom_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wunused-result
  -Wno-missing-field-initializers)  # what a designated initialiser leaves out has its default

# Of folders that compute with vectors: with one rounding per operation, on every kind of CPU. And GCC
# 12, for AVX-512, takes a bool that decides over whole vectors in a loop for the mask of their lanes,
# and so over the first lane alone (few_rays_test), where it converts branches of loops.
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

# viewloom_add_library(<folder> SOURCES ... HEADERS ... [LINK ...]): static library viewloom_<folder>.
# Includes are written from server/core, server/ and client/.
function(viewloom_add_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINK" ${ARGN})
  set(target viewloom_${folder})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE viewloom_options)
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
  set(roots ${PROJECT_SOURCE_DIR}/server/core ${PROJECT_SOURCE_DIR}/server
    ${PROJECT_SOURCE_DIR}/client)
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

# viewloom_add_test(<name> LABEL <unit|gpu|e2e|...> SOURCES ... [LINK ...]): one GoogleTest program,
# registered as one ctest case.
function(viewloom_add_test name)
  cmake_parse_arguments(ARG "" "LABEL" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE viewloom_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name})
  # Of hung tests; slow machines are busy with others, too.
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 900)
endfunction()
