// SPDX-License-Identifier: Apache-2.0
// Makes a bitmap of the pictures of a video on the CPU: the browser converts each picture, and the
// rows of each view are copied to its tile. Fast where WebGL is a program, slower with a GPU.
import {cellOrigin} from './video_planes.js';
import {tileOrigin} from './tile_origin.js';
import {viewsOfPicture} from './video_painter.js';

const kOpaqueBlack = new Uint32Array(new Uint8Array([0, 0, 0, 255]).buffer)[0];

// Older browsers give the samples as they are, whatever format is asked for.
export function canConvert(frame) {
  const {width, height} = frame.visibleRect;
  try {
    return frame.allocationSize({format: 'RGBA'}) === 4 * width * height;
  } catch {
    return false;
  }
}

export class VideoConversion {
  #picture = null;  // Uint32Array, a px each
  #image = null;
  #pixels = null;   // those of #image
  #layout = null;

  // layout: AtlasLayout of the atlas whose pictures come next.
  begin(layout) {
    const isSame = JSON.stringify(layout) === JSON.stringify(this.#layout);
    this.#layout = layout;
    if (isSame) return;
    const {picture_size} = layout.video;
    this.#picture = new Uint32Array(picture_size.width * picture_size.height);
    this.#image = new ImageData(layout.size.width, layout.size.height);
    this.#pixels = new Uint32Array(this.#image.data.buffer).fill(kOpaqueBlack);  // padding
  }

  async put(index, frame) {
    const {video, view_count} = this.#layout;
    await frame.copyTo(this.#picture, {format: 'RGBA'});
    for (let cell = 0; cell < viewsOfPicture(video, view_count, index); ++cell) {
      this.#copy(cellOrigin(video, cell), index + cell * video.picture_count);
    }
  }

  // {bitmap}, once all pictures were put.
  async finish() {
    return {bitmap: await createImageBitmap(this.#image, {premultiplyAlpha: 'none'})};
  }

  close() {
    this.#picture = this.#image = this.#pixels = this.#layout = null;
  }

  #copy(from, view) {
    const {video, size, tile_size} = this.#layout;
    const to = tileOrigin(this.#layout, view);
    for (let row = 0; row < tile_size.height; ++row) {
      const begin = (from.y + row) * video.picture_size.width + from.x;
      this.#pixels.set(this.#picture.subarray(begin, begin + tile_size.width),
                       (to.y + row) * size.width + to.x);
    }
  }
}
