// SPDX-License-Identifier: Apache-2.0
// Copies the samples of all pictures of a video out of the decoder's frames. Fast where the decoder
// is a program. Shaders convert them where they are drawn (video_textures.js).

// Sizes of the planes: bytes from one kind to the next, of so many pictures.
export function planeSizes({picture_count, picture_size: {width, height}}) {
  const chroma_px = {width: width / 2, height: height / 2};
  return {
    chroma_px,
    luma_bytes: picture_count * width * height,
    chroma_bytes: picture_count * chroma_px.width * chroma_px.height,
  };
}

// Top left corner of a cell in its picture, px.
export function cellOrigin({columns, cell_size}, cell) {
  return {x: cell % columns * cell_size.width, y: Math.floor(cell / columns) * cell_size.height};
}

export class VideoPlanes {
  #bytes = null;
  #spare = [];  // that were used before: fresh memory takes longer than the copies
  #video = null;

  // layout: AtlasLayout of the atlas whose pictures come next.
  begin({video}) {
    const {luma_bytes, chroma_bytes} = planeSizes(video);
    const size_bytes = luma_bytes + 2 * chroma_bytes;
    this.#video = video;
    this.#spare = this.#spare.filter(({length}) => length === size_bytes);
    this.#bytes = this.#spare.pop() ?? new Uint8Array(size_bytes);
  }

  // Takes planes back that nobody reads any more.
  recycle(planes) {
    this.#spare.push(planes);
  }

  async put(index, frame) {
    const {picture_size: {width, height}} = this.#video;
    const {chroma_px, luma_bytes, chroma_bytes} = planeSizes(this.#video);
    const chroma = luma_bytes + index * chroma_px.width * chroma_px.height;
    await frame.copyTo(this.#bytes, {layout: [
      {offset: index * width * height, stride: width},
      {offset: chroma, stride: chroma_px.width},
      {offset: chroma + chroma_bytes, stride: chroma_px.width},
    ]});
  }

  // {planes}: Y of all pictures, then their Cb, then their Cr.
  finish() {
    const planes = this.#bytes;
    this.#bytes = null;
    return {planes};
  }

  close() {}
}
