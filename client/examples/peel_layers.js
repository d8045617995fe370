// SPDX-License-Identifier: Apache-2.0
// Depth peeling in plain WebGL2: the surfaces that a camera sees one behind the other, as layers of
// colour and 1/Z for viewloom.

// Goes into the fragment shader of everything that is drawn: what is left is the nearest surface
// behind the layer before. inv_z: 1/Z in 1/m, Z along the view axis.
export const PEEL_GLSL = `
  uniform highp sampler2D inv_z_before;  // of the layer before, 0 where it has nothing
  uniform highp float kept_share;        // 1 - the minimum separation
  layout(location = 1) out highp vec4 peeled_inv_z;
  void peel(highp float inv_z) {
    highp float before = texelFetch(inv_z_before, ivec2(gl_FragCoord.xy), 0).r;
    if (inv_z >= before * kept_share) discard;
    peeled_inv_z = vec4(inv_z, 0.0, 0.0, 1.0);
  }`;

const IN_FRONT = 1e9; // 1/m: before the first layer, everything is kept

export class LayerPeeler {
  // minSeparation: how much further than the layer before a surface must lie, as a share of 1/Z.
  // Less than viewloom's step between surfaces (up to 2.7 % of the picture's range of 1/Z), and
  // two layers become one again.
  constructor(gl, {widthPx, heightPx, layerCount = 2, minSeparation = 0.05}) {
    if (!gl.getExtension("EXT_color_buffer_float")) {
      throw new Error("peeling needs EXT_color_buffer_float, which this device lacks");
    }
    Object.assign(this, {gl, widthPx, heightPx, layerCount, minSeparation});
    this.targets = [this._makeTarget(), this._makeTarget()]; // one is read, the other drawn to
  }

  _makeTarget() {
    const gl = this.gl;
    const texture = (format) => {
      const made = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, made);
      gl.texStorage2D(gl.TEXTURE_2D, 1, format, this.widthPx, this.heightPx);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      return made;
    };
    const target = {color: texture(gl.RGBA8), invZ: texture(gl.R32F),
                    framebuffer: gl.createFramebuffer()};
    const depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, this.widthPx, this.heightPx);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target.color, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, target.invZ, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    return target;
  }

  // draw(setPeel) draws the whole scene once for every layer; it calls setPeel(program) for each
  // program in use. Returns [{color: Uint8Array (RGBA), invZ: Float32Array (1/m, 0 = nothing)}],
  // nearest layer first, top row first.
  peel(draw) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[1].framebuffer);
    gl.clearBufferfv(gl.COLOR, 1, [IN_FRONT, 0, 0, 0]);
    gl.viewport(0, 0, this.widthPx, this.heightPx);
    // A layer holds the faces that look at the camera, each once: no far sides of bodies, and no
    // multisampling, which would mix the depths of two surfaces.
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    const layers = [];
    for (let layer = 0; layer < this.layerCount; ++layer) {
      const [drawn, before] = [this.targets[layer % 2], this.targets[(layer + 1) % 2]];
      gl.bindFramebuffer(gl.FRAMEBUFFER, drawn.framebuffer);
      gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
      gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      draw((program) => {
        gl.activeTexture(gl.TEXTURE7);
        gl.bindTexture(gl.TEXTURE_2D, before.invZ);
        gl.uniform1i(gl.getUniformLocation(program, "inv_z_before"), 7);
        gl.uniform1f(gl.getUniformLocation(program, "kept_share"), 1 - this.minSeparation);
      });
      layers.push(this._read());
    }
    return layers;
  }

  _read() {
    const gl = this.gl;
    const [width, height] = [this.widthPx, this.heightPx];
    const color = new Uint8Array(4 * width * height);
    const floats = new Float32Array(4 * width * height); // RGBA alone is read everywhere
    gl.readBuffer(gl.COLOR_ATTACHMENT0);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, color);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, floats);
    const layer = {color: new Uint8Array(color.length), invZ: new Float32Array(width * height)};
    for (let y = 0; y < height; ++y) {
      const from = (height - 1 - y) * width; // WebGL's rows run upwards
      layer.color.set(color.subarray(4 * from, 4 * (from + width)), 4 * y * width);
      for (let x = 0; x < width; ++x) layer.invZ[y * width + x] = floats[4 * (from + x)];
    }
    return layer;
  }
}
