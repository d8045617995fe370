# SPDX-License-Identifier: Apache-2.0
# cmake -D "PUBLIC=client/lib/a.h;base/b.h" -D "DETAIL=client/lib/c.h" -D OUTPUT=include -P
# InstalledHeaders.cmake: the headers as users include them, <viewloom/a.h>. Those of DETAIL are in
# viewloom/detail. What one includes of the others is written accordingly. Nothing else of viewloom's may
# be included, but for messages (viewloom/v1/*.pb.h).
cmake_minimum_required(VERSION 3.25)
foreach(header IN LISTS PUBLIC DETAIL)
  cmake_path(GET header FILENAME name)
  cmake_path(GET header PARENT_PATH folder)
  cmake_path(GET folder FILENAME folder)
  if(header IN_LIST DETAIL)
    set(place detail/${name})
  else()
    set(place ${name})
  endif()
  list(APPEND before "#include \"${folder}/${name}\"")
  list(APPEND after "#include \"viewloom/${place}\"")
  list(APPEND places ${place})
endforeach()

file(REMOVE_RECURSE ${OUTPUT})
set(headers ${PUBLIC} ${DETAIL})
foreach(header place IN ZIP_LISTS headers places)
  file(READ ${header} text)
  foreach(old new IN ZIP_LISTS before after)
    string(REPLACE "${old}" "${new}" text "${text}")
  endforeach()
  string(REGEX MATCHALL "#include \"[^\"]+\"" includes "${text}")
  list(FILTER includes EXCLUDE REGEX "\"(viewloom|absl)/")
  if(includes)
    message(FATAL_ERROR "${header} is installed, but not what it includes: ${includes}")
  endif()
  file(WRITE ${OUTPUT}/viewloom/${place} "${text}")
endforeach()
