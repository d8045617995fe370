// SPDX-License-Identifier: Apache-2.0

// A texture that is bound now: without coarser levels, and without repetition. filter: gl.NEAREST
// or gl.LINEAR; target: gl.TEXTURE_2D or gl.TEXTURE_2D_ARRAY.
export function makeTexture(gl, filter, target = gl.TEXTURE_2D) {
  const texture = gl.createTexture();
  gl.bindTexture(target, texture);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(target, name, filter);
  }
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
    gl.texParameteri(target, name, gl.CLAMP_TO_EDGE);
  }
  return texture;
}
