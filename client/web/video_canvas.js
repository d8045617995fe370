// SPDX-License-Identifier: Apache-2.0
// Draws parts of an atlas into a canvas of two dimensions: from its bitmap, or from the planes of a
// video, converted where they are drawn.
import {GlProgram} from './gl_program.js';
import {kAtlasFragment} from './video_shaders.js';
import {VideoTextures} from './video_textures.js';

const kTapsMax = 4;  // of a px, in each direction; each is a mean of 2x2 px by itself

export class VideoCanvas {
  #canvas = null;
  #gl = null;
  #program = null;
  #textures = null;

  // onFailed(reason): planes cannot be drawn here.
  constructor(onFailed) {
    this.onFailed = onFailed;
  }

  // Like context.drawImage. source, target: [x, y, width, height], px.
  draw(context, atlas, source, target) {
    if (atlas.bitmap) {
      context.drawImage(atlas.bitmap, ...source, ...target);
      return;
    }
    const [width, height] = [Math.max(1, target[2]), Math.max(1, target[3])];
    try {
      this.#start();
    } catch (error) {
      this.onFailed(error.message);
      return;
    }
    if (this.#gl.isContextLost()) return;
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, {width, height});
    }
    this.#paint(atlas, source, width, height);
    context.drawImage(this.#canvas, target[0], target[1]);
  }

  // Once, and again when the device was lost.
  #start() {
    if (!this.#canvas) {
      this.#canvas = new OffscreenCanvas(1, 1);
      this.#canvas.addEventListener('webglcontextlost', (event) => {
        event.preventDefault();  // it comes back
        this.#program = null;
      });
      this.#gl = this.#canvas.getContext('webgl2', {alpha: false, antialias: false, depth: false});
      if (!this.#gl) throw new Error('this browser has no WebGL2');
    }
    if (this.#program || this.#gl.isContextLost()) return;
    this.#program = new GlProgram(this.#gl, kAtlasFragment);
    this.#textures = new VideoTextures(this.#gl);
  }

  #paint(atlas, [x, y, source_width, source_height], width, height) {
    const {layout} = atlas.header;
    this.#textures.use(atlas, this.#program);
    const shrink = Math.max(source_width / width, source_height / height);
    this.#program.draw(width, height, {
      uints: {
        view_count: layout.view_count, tile_columns: layout.columns, tile_rows: layout.rows,
        padding_top_px: layout.padding_top_px,
        is_bottom_left: layout.order === 'BOTTOM_LEFT' ? 1 : 0,
        taps: Math.min(kTapsMax, Math.max(1, Math.round(shrink / 2))),
      },
      floats: {
        source_px: [x, y], source_size_px: [source_width, source_height],
        target_px: [width, height],
      },
    });
  }
}
