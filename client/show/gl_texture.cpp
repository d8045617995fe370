// SPDX-License-Identifier: Apache-2.0
#include "show/gl_texture.h"

#include <epoxy/gl.h>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom::show {

GlTexture::GlTexture() {
  glGenTextures(1, &texture_);
  bind();
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlTexture::~GlTexture() {
  glDeleteTextures(1, &texture_);
}

void GlTexture::bind() const {
  glBindTexture(GL_TEXTURE_2D, texture_);
}

absl::Status GlTexture::upload(SizePx size_px, uint32_t channels,
                               std::span<const uint8_t> samples) {
  VIEWLOOM_CHECK(samples.size() == size_px.area() * channels);
  int side_max_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side_max_px);
  const auto limit_px = static_cast<uint32_t>(side_max_px);
  if (size_px.width > limit_px || size_px.height > limit_px) {
    return absl::ResourceExhaustedError(strCat("the atlas has ", size_px.width, "x", size_px.height,
                                               " px; this graphics card takes up to ", limit_px,
                                               " a side. Ask for a smaller one with --size"));
  }
  bind();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const auto width = static_cast<int>(size_px.width);
  const auto height = static_cast<int>(size_px.height);
  const uint32_t format = channels == 3 ? GL_RGB : GL_RGBA;
  if (size_px == size_px_ && channels == channels_) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format, GL_UNSIGNED_BYTE,
                    samples.data());
    return absl::OkStatus();
  }
  size_px_ = size_px;
  channels_ = channels;
  glTexImage2D(GL_TEXTURE_2D, 0, channels == 3 ? GL_RGB8 : GL_RGBA8, width, height, 0, format,
               GL_UNSIGNED_BYTE, samples.data());
  return absl::OkStatus();
}

}  // namespace viewloom::show
