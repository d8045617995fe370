// SPDX-License-Identifier: Apache-2.0
#include "show/gl_program.h"

#include <epoxy/gl.h>

#include <utility>

#include "base/str_cat.h"

namespace viewloom::show {
namespace {

constexpr std::string_view kGlVersion = "#version 330 core\n";
constexpr std::string_view kGlesVersion =
    "#version 300 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n";

absl::Status compileInto(uint32_t program, uint32_t kind, std::string_view text, bool is_gles) {
  const std::string_view version = is_gles ? kGlesVersion : kGlVersion;
  const std::array<const char*, 2> parts = {version.data(), text.data()};
  const std::array<int, 2> sizes = {static_cast<int>(version.size()),
                                    static_cast<int>(text.size())};
  const uint32_t shader = glCreateShader(kind);
  glShaderSource(shader, 2, parts.data(), sizes.data());
  glCompileShader(shader);
  int is_good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
  std::array<char, 1000> said = {};
  if (is_good == 0) glGetShaderInfoLog(shader, said.size() - 1, nullptr, said.data());
  glAttachShader(program, shader);
  glDeleteShader(shader);  // lives for as long as it is attached
  if (is_good != 0) return absl::OkStatus();
  return absl::InternalError(strCat("the graphics driver refuses a shader: ", said.data()));
}

}  // namespace

absl::StatusOr<GlProgram> GlProgram::make(std::string_view vertex, std::string_view fragment,
                                          bool is_gles) {
  GlProgram program(glCreateProgram());
  VIEWLOOM_RETURN_IF_ERROR(compileInto(program.program_, GL_VERTEX_SHADER, vertex, is_gles));
  VIEWLOOM_RETURN_IF_ERROR(compileInto(program.program_, GL_FRAGMENT_SHADER, fragment, is_gles));
  glLinkProgram(program.program_);
  int is_good = 0;
  glGetProgramiv(program.program_, GL_LINK_STATUS, &is_good);
  if (is_good != 0) return program;
  std::array<char, 1000> said = {};
  glGetProgramInfoLog(program.program_, said.size() - 1, nullptr, said.data());
  return absl::InternalError(strCat("the graphics driver links no program: ", said.data()));
}

GlProgram::~GlProgram() {
  glDeleteProgram(program_);
}

GlProgram::GlProgram(GlProgram&& other) noexcept : program_(std::exchange(other.program_, 0)) {}

void GlProgram::use() const {
  glUseProgram(program_);
}

int GlProgram::locationOf(const char* name) const {
  return glGetUniformLocation(program_, name);
}

void GlProgram::set(const char* name, uint32_t value) const {
  glUniform1ui(locationOf(name), value);
}

void GlProgram::set(const char* name, std::span<const uint32_t> values) const {
  glUniform1uiv(locationOf(name), static_cast<int>(values.size()), values.data());
}

void GlProgram::set(const char* name, std::array<uint32_t, 2> value) const {
  glUniform2ui(locationOf(name), value[0], value[1]);
}

void GlProgram::set(const char* name, float value) const {
  glUniform1f(locationOf(name), value);
}

void GlProgram::set(const char* name, std::array<float, 2> value) const {
  glUniform2f(locationOf(name), value[0], value[1]);
}

void GlProgram::set(const char* name, std::array<float, 4> value) const {
  glUniform4f(locationOf(name), value[0], value[1], value[2], value[3]);
}

}  // namespace viewloom::show
