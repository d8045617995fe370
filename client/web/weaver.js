// SPDX-License-Identifier: Apache-2.0
// Weaves quilts for a calibrated panel, px by px, and shows the panel or what an eye sees of it.
import {lensCount} from './calibration.js';
import {GlProgram} from './gl_program.js';
import {makeTexture} from './gl_texture.js';
import {makeLenticular} from './lenticular.js';
import {VideoTextures} from './video_textures.js';
import {fetchShaders} from './weave_shaders.js';

export class Weaver {
  #gl = null;
  #shaders = null;
  #programs = null;
  #quilt = null;
  #planes = null;    // textures of a video
  #panel = null;     // {texture, framebuffer}: the woven panel, for the eye
  #uploaded = null;  // the atlas that is in #quilt
  #woven = {};       // what is in #panel: {atlas, calibration}

  constructor(canvas) {
    this.canvas = canvas;
    this.calibration = null;
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();  // it comes back
      this.#programs = null;
    });
  }

  // Throws an Error with one sentence where the browser cannot weave.
  async prepare() {
    this.#gl ??= this.canvas.getContext('webgl2', {alpha: false, antialias: false});
    if (!this.#gl) {
      throw new Error('This browser has no WebGL2: switch hardware acceleration on in its ' +
                      'settings, or take another browser.');
    }
    const shaders = this.#shaders ?? await fetchShaders();
    this.#start(shaders);
    this.#shaders = shaders;
  }

  get side_max_px() { return this.#gl.getParameter(this.#gl.MAX_TEXTURE_SIZE); }

  // Once, and again when the device was lost.
  #start(shaders) {
    const gl = this.#gl;
    if (this.#programs || gl.isContextLost()) return;
    this.#programs = {
      weave: new GlProgram(gl, shaders.weave),
      weaveStack: new GlProgram(gl, shaders.weaveStack),
      eye: new GlProgram(gl, shaders.eye),
    };
    this.#quilt = makeTexture(gl, gl.LINEAR);
    this.#planes = new VideoTextures(gl);
    this.#panel = {texture: makeTexture(gl, gl.NEAREST), framebuffer: gl.createFramebuffer()};
    this.#uploaded = null;
    this.#woven = {};
  }

  // Whether there is all that drawing takes; the quilt is on the device from then on.
  #load(atlas) {
    const gl = this.#gl;
    if (!gl || gl.isContextLost() || !this.#shaders || !this.calibration) return false;
    this.#start(this.#shaders);
    if (atlas.planes || this.#uploaded === atlas) return true;
    gl.bindTexture(gl.TEXTURE_2D, this.#quilt);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, atlas.bitmap);
    this.#uploaded = atlas;
    return true;
  }

  // Panel px are canvas px, from the top left corner.
  drawPanel(atlas) {
    if (!this.#load(atlas)) return;
    this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, null);
    this.#weave(atlas, this.canvas.width, this.canvas.height);
  }

  // eye, blur: see the shader; panel_px_per_px: how many px of the panel one of the canvas shows.
  drawEye(atlas, {eye, blur, panel_px_per_px, is_bare}) {
    if (!this.#load(atlas)) return;
    const gl = this.#gl;
    const {screen_px} = this.calibration;
    if (this.#woven.atlas !== atlas || this.#woven.calibration !== this.calibration) {
      this.#weavePanel(atlas);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, this.#panel.texture);
    const {width, height} = this.canvas;
    const lens_width_px = screen_px.width / Math.abs(lensCount(this.calibration));
    this.#setLens(this.#programs.eye);
    this.#programs.eye.draw(width, height, {
      uints: {panel_px: [screen_px.width, screen_px.height], is_bare: is_bare ? 1 : 0},
      floats: {eye, target_px: [width, height], blur, lens_width_px,
               panel_px_per_px},
    });
  }

  #weavePanel(atlas) {
    const gl = this.#gl;
    const {width, height} = this.calibration.screen_px;
    gl.bindTexture(gl.TEXTURE_2D, this.#panel.texture);
    if (this.#woven.calibration !== this.calibration) {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.#panel.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D,
                            this.#panel.texture, 0);
    this.#weave(atlas, width, height);
    this.#woven = {atlas, calibration: this.calibration};
  }

  #weave(atlas, width_px, height_px) {
    const {layout} = atlas.header;
    const {screen_px} = this.calibration;
    const program = atlas.planes ? this.#programs.weaveStack : this.#programs.weave;
    this.#setLens(program);
    program.set({uints: {
      panel_px: [screen_px.width, screen_px.height],
      view_count: layout.view_count,
      target_height_px: height_px,
    }});
    if (atlas.planes) this.#planes.use(atlas, program);
    else this.#useQuilt(layout, program);
    program.draw(width_px, height_px, {});
  }

  #useQuilt(layout, program) {
    this.#gl.bindTexture(this.#gl.TEXTURE_2D, this.#quilt);
    program.set({uints: {
      tile_px: [layout.tile_size.width, layout.tile_size.height],
      columns: layout.columns,
      rows: layout.rows,
      padding_top_px: layout.padding_top_px,
      is_bottom_left: layout.order === 'BOTTOM_LEFT' ? 1 : 0,
    }});
  }

  #setLens(program) {
    const {gl} = program;
    gl.useProgram(program.program);
    for (const [name, value] of Object.entries(makeLenticular(this.calibration))) {
      if (name === 'cell_phase') gl.uniform1uiv(program.place('lens.cell_phase'), value);
      else gl.uniform1ui(program.place(`lens.${name}`), value);
    }
  }
}
