// SPDX-License-Identifier: Apache-2.0
// A WebGL2 program. Unless it has vertices of its own, it covers its target with one triangle.

const kCover = `#version 300 es
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1);
}`;

function compile(gl, type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (gl.getShaderParameter(shader, gl.COMPILE_STATUS) || gl.isContextLost()) return shader;
  throw new Error(`a shader does not compile here: ${gl.getShaderInfoLog(shader)}`);
}

export class GlProgram {
  #places = {};

  constructor(gl, fragment, vertex = kCover) {
    this.gl = gl;
    this.program = gl.createProgram();
    gl.attachShader(this.program, compile(gl, gl.VERTEX_SHADER, vertex));
    gl.attachShader(this.program, compile(gl, gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(`a shader does not link here: ${gl.getProgramInfoLog(this.program)}`);
    }
  }

  place(name) {
    return this.#places[name] ??= this.gl.getUniformLocation(this.program, name);
  }

  // uints, floats: by name, a number, or up to four.
  set({uints = {}, floats = {}}) {
    const {gl} = this;
    gl.useProgram(this.program);
    for (const [kind, values] of [['ui', uints], ['f', floats]]) {
      for (const [name, value] of Object.entries(values)) {
        const list = [value].flat();
        gl[`uniform${list.length}${kind}v`](this.place(name), list);
      }
    }
  }

  // Draws to the framebuffer that is bound. values: see set().
  draw(width_px, height_px, values) {
    this.set(values);
    this.gl.viewport(0, 0, width_px, height_px);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }
}
