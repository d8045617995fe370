// SPDX-License-Identifier: Apache-2.0
// Draws parts of an atlas into a canvas of two dimensions: from its bitmap, or from the planes of a
// video. Those are converted here, at about the size at which they are seen.
import {tileOrigin} from './tile_origin.js';
import {cellOrigin, planeSizes} from './video_planes.js';

const kShrinkMax = 8;

// Whole px that become one: a power of two, so that the picture stays as large as it is seen.
function shrinkOf([, , width, height], [, , target_width, target_height], tile_size) {
  const wanted = Math.min(width / target_width, height / target_height, kShrinkMax,
      tile_size.width, tile_size.height);
  return 2 ** Math.max(0, Math.floor(Math.log2(wanted)));
}

// Place of one view: where its px begin in the planes, and in the picture that is made.
class ViewPlace {
  constructor({video, tile_size}, view, origin, shrink) {
    const {picture_size: {width, height}, picture_count} = video;
    const {luma_bytes, chroma_bytes} = planeSizes(video);
    const picture = view % picture_count;
    const cell = cellOrigin(video, Math.floor(view / picture_count));
    this.tile_size = tile_size;
    this.stride = width;
    this.luma = (picture * height + cell.y) * width + cell.x;
    this.cb = luma_bytes + (picture * height + cell.y) / 2 * width / 2 + cell.x / 2;
    this.cr = this.cb + chroma_bytes;
    this.origin = origin;
    // Px whose middle lies in the tile.
    this.left = Math.ceil(origin.x / shrink - 0.5);
    this.top = Math.ceil(origin.y / shrink - 0.5);
    this.width = Math.ceil((origin.x + tile_size.width) / shrink - 0.5) - this.left;
    this.height = Math.ceil((origin.y + tile_size.height) / shrink - 0.5) - this.top;
  }
}

// Sum of side x side samples.
function blockSum(planes, at, stride, side) {
  let sum = 0;
  for (let row = 0; row < side; ++row, at += stride) {
    for (let column = 0; column < side; ++column) sum += planes[at + column];
  }
  return sum;
}

// Writes R, G and B of the view to `pixels`: means of shrink x shrink px, full range, BT.601.
// Blocks never reach into neighbours.
function convertView(planes, place, shrink, pixels) {
  const {stride, tile_size, origin} = place;
  const chroma_side = Math.max(1, shrink / 2);
  const [luma_scale, chroma_scale] = [1 / shrink ** 2, 1 / chroma_side ** 2];
  let to = 0;
  for (let row = 0; row < place.height; ++row) {
    const y = Math.min(Math.max((place.top + row) * shrink - origin.y, 0),
                       tile_size.height - shrink);
    const luma_row = place.luma + y * stride;
    const chroma_row = (y >> 1) * (stride / 2);
    for (let column = 0; column < place.width; ++column, to += 4) {
      const x = Math.min(Math.max((place.left + column) * shrink - origin.x, 0),
                         tile_size.width - shrink);
      const chroma = chroma_row + (x >> 1);
      const level = luma_scale * blockSum(planes, luma_row + x, stride, shrink);
      const blue = chroma_scale * blockSum(planes, place.cb + chroma, stride / 2, chroma_side) -
          128;
      const red = chroma_scale * blockSum(planes, place.cr + chroma, stride / 2, chroma_side) - 128;
      pixels[to] = level + 1.402 * red;
      pixels[to + 1] = level - 0.344136 * blue - 0.714136 * red;
      pixels[to + 2] = level + 1.772 * blue;
    }
  }
}

export class VideoCanvas {
  #canvas = new OffscreenCanvas(1, 1);
  // The pixels come from this thread.
  #context = this.#canvas.getContext('2d', {alpha: false, willReadFrequently: true});
  #image = null;  // of one view
  #drawn = {};    // what the canvas holds: {atlas, part}

  // Like context.drawImage. source, target: [x, y, width, height], px.
  draw(context, atlas, source, target) {
    if (atlas.bitmap) {
      context.drawImage(atlas.bitmap, ...source, ...target);
      return;
    }
    const shrink = shrinkOf(source, target, atlas.header.layout.tile_size);
    const part = [shrink, ...source].join();
    if (this.#drawn.atlas !== atlas || this.#drawn.part !== part) {
      this.#convert(atlas, source, shrink);
    }
    this.#drawn = {atlas, part};
    context.drawImage(this.#canvas, ...source.map((px) => px / shrink), ...target);
  }

  // Views that reach into the source.
  #convert({planes, header: {layout}}, [x, y, width, height], shrink) {
    const {size, tile_size, view_count} = layout;
    const [canvas_width, canvas_height] =
        [size.width, size.height].map((px) => Math.ceil(px / shrink));
    if (this.#canvas.width !== canvas_width || this.#canvas.height !== canvas_height) {
      Object.assign(this.#canvas, {width: canvas_width, height: canvas_height});
    }
    this.#context.fillRect(0, 0, canvas_width, canvas_height);  // where no view is
    for (let view = 0; view < view_count; ++view) {
      const origin = tileOrigin(layout, view);
      const isSeen = origin.x < x + width && origin.x + tile_size.width > x &&
          origin.y < y + height && origin.y + tile_size.height > y;
      if (isSeen) this.#put(planes, new ViewPlace(layout, view, origin, shrink), shrink);
    }
  }

  #put(planes, place, shrink) {
    const {width, height} = place;
    if (width < 1 || height < 1) return;
    if (this.#image?.width !== width || this.#image.height !== height) {
      this.#image = new ImageData(width, height);
      this.#image.data.fill(255);  // opaque
    }
    convertView(planes, place, shrink, this.#image.data);
    this.#context.putImageData(this.#image, place.left, place.top);
  }
}
