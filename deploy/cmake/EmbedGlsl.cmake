# SPDX-License-Identifier: Apache-2.0
# cmake -D OUTPUT=x.cpp -D SHADERS=shaders -D "FILES=show/a.vert show/b.frag" -P EmbedGlsl.cmake: texts of
# shaders, what they include written out, for client/show/shader_texts.h. The #version is for the caller.
separate_arguments(FILES)
foreach(name IN LISTS FILES)
  file(READ ${SHADERS}/${name} text)
  while(text MATCHES "#include \"([a-z_/]+[.]h)\"\n")
    set(line "${CMAKE_MATCH_0}")
    file(READ ${SHADERS}/${CMAKE_MATCH_1} included)
    string(REPLACE "${line}" "${included}" text "${text}")
  endwhile()
  get_filename_component(stem ${name} NAME_WE)
  get_filename_component(kind ${name} EXT)
  string(SUBSTRING ${stem} 0 1 initial)
  string(SUBSTRING ${stem} 1 -1 rest)
  string(TOUPPER ${initial} initial)
  set(suffix_of.vert Vertex)
  set(suffix_of.frag Fragment)
  string(APPEND texts
    "const std::string_view k${initial}${rest}${suffix_of${kind}} = R\"viewloom(${text})viewloom\";\n\n")
endforeach()

file(WRITE ${OUTPUT} "#include \"show/shader_texts.h\"

namespace viewloom::show {

${texts}}  // namespace viewloom::show
")
