// SPDX-License-Identifier: Apache-2.0
// Makes a bitmap of the pictures of a video: the browser converts and uploads each picture, and the
// views go to their tiles. Fast where decoder and WebGL share a GPU.
import {GlProgram} from './gl_program.js';
import {makeTexture} from './gl_texture.js';
import {kCellsFragment, kCellsVertex} from './video_shaders.js';

// Views in picture `index` of a stack.
export function viewsOfPicture({picture_count}, view_count, index) {
  return Math.max(0, Math.ceil((view_count - index) / picture_count));
}

export class VideoPainter {
  #canvas = new OffscreenCanvas(1, 1);
  #gl = this.#canvas.getContext('webgl2', {alpha: false, antialias: false, depth: false});
  #program = null;
  #textures = [];  // by picture
  #layout = null;

  // Throws an Error where there is no WebGL2.
  constructor() {
    if (!this.#gl) throw new Error('the browser has no WebGL2 for workers');
    this.#program = new GlProgram(this.#gl, kCellsFragment, kCellsVertex);
  }

  // layout: AtlasLayout of the atlas whose pictures come next.
  begin(layout) {
    const gl = this.#gl;
    const {width, height} = layout.size;
    const side_max_px = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    if (Math.max(width, height) > side_max_px) {
      throw new Error(`the picture is larger than the ${side_max_px} px that WebGL takes here`);
    }
    if (gl.isContextLost()) throw new Error('the browser has lost its graphics device');
    this.#layout = layout;
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, {width, height});
    }
  }

  async put(index, frame) {
    const gl = this.#gl;
    this.#textures[index] ??= makeTexture(gl, gl.NEAREST);
    gl.bindTexture(gl.TEXTURE_2D, this.#textures[index]);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, frame);
  }

  // {bitmap}, once all pictures were put. Waits for the device, so that its time can be measured.
  finish() {
    const gl = this.#gl;
    gl.viewport(0, 0, this.#canvas.width, this.#canvas.height);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    for (let index = 0; index < this.#layout.video.picture_count; ++index) this.#draw(index);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return {bitmap: this.#canvas.transferToImageBitmap()};
  }

  close() {
    this.#gl.getExtension('WEBGL_lose_context')?.loseContext();
  }

  #draw(index) {
    const gl = this.#gl;
    const {size, video, view_count, tile_size, columns, rows, padding_top_px, order} =
        this.#layout;
    gl.bindTexture(gl.TEXTURE_2D, this.#textures[index]);
    this.#program.set({
      uints: {
        picture: index, picture_count: video.picture_count, cell_columns: video.columns,
        tile_columns: columns, tile_rows: rows, padding_top_px,
        is_bottom_left: order === 'BOTTOM_LEFT' ? 1 : 0,
        cell_px: [video.cell_size.width, video.cell_size.height],
        tile_px: [tile_size.width, tile_size.height],
      },
      floats: {target_px: [size.width, size.height]},
    });
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, viewsOfPicture(video, view_count, index));
  }
}
