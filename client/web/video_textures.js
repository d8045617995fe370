// SPDX-License-Identifier: Apache-2.0
// Planes of a video as textures of one WebGL context, for the shaders' kStackLookup.
import {makeTexture} from './gl_texture.js';
import {planeSizes} from './video_planes.js';

export class VideoTextures {
  #gl;
  #textures = null;  // {luma, cb, cr}
  #size = '';
  #atlas = null;     // whose planes they hold

  constructor(gl) {
    this.#gl = gl;
  }

  // Binds the planes of an atlas to the first units, and sets what kStackLookup reads.
  use(atlas, program) {
    const gl = this.#gl;
    const {video, tile_size} = atlas.header.layout;
    if (this.#atlas !== atlas) this.#upload(atlas.planes, video);
    this.#atlas = atlas;
    program.set({uints: {
      stack_count: video.picture_count, cell_columns: video.columns,
      cell_px: [video.cell_size.width, video.cell_size.height],
      view_px: [tile_size.width, tile_size.height],
    }});
    ['luma', 'cb', 'cr'].forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.#textures[name]);
      gl.uniform1i(program.place(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
  }

  #upload(planes, video) {
    const {picture_count, picture_size} = video;
    const {chroma_px, luma_bytes, chroma_bytes} = planeSizes(video);
    const size = `${picture_count} ${picture_size.width}x${picture_size.height}`;
    if (this.#size !== size) this.#allocate(video, chroma_px);
    this.#size = size;
    this.#fill(this.#textures.luma, picture_size, picture_count, planes, 0);
    this.#fill(this.#textures.cb, chroma_px, picture_count, planes, luma_bytes);
    this.#fill(this.#textures.cr, chroma_px, picture_count, planes, luma_bytes + chroma_bytes);
  }

  #allocate({picture_count, picture_size}, chroma_px) {
    const gl = this.#gl;
    for (const texture of Object.values(this.#textures ?? {})) gl.deleteTexture(texture);
    const make = ({width, height}) => {
      const texture = makeTexture(gl, gl.LINEAR, gl.TEXTURE_2D_ARRAY);
      gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.R8, width, height, picture_count);
      return texture;
    };
    this.#textures = {luma: make(picture_size), cb: make(chroma_px), cr: make(chroma_px)};
  }

  #fill(texture, {width, height}, count, bytes, offset) {
    const gl = this.#gl;
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, count, gl.RED,
                     gl.UNSIGNED_BYTE, bytes, offset);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
  }
}
