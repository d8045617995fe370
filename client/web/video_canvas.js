// SPDX-License-Identifier: Apache-2.0
// Draws parts of an atlas into a canvas of two dimensions: from its bitmap, or from the planes of a
// video. Those are converted here, at about the size at which they are seen.
import {tileOrigin} from './tile_origin.js';
import {cellOrigin, planeSizes} from './video_planes.js';

const kShrinkMax = 8;
// How much smaller than seen a picture may be made, as a logarithm to base 2: a fifth on each side.
const kBlur = 0.25;

// Whole px that become one, to each side: a power of two.
function shrinkOf([, , width, height], [, , target_width, target_height], tile_size) {
  // No block is larger than a view.
  const sides = [tile_size.width, tile_size.height].map((px) => 2 ** Math.floor(Math.log2(px)));
  const wanted = Math.min(width / target_width, height / target_height, kShrinkMax);
  const shrink = 2 ** Math.max(0, Math.floor(Math.log2(wanted) + kBlur));
  return Math.min(shrink, ...sides);
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

// Adds samples to the sums of blocks, `side` in a row each. begins: of the blocks, from `at` on.
function addRow(sums, planes, at, begins, side) {
  for (let block = 0; block < sums.length; ++block) {
    const begin = at + begins[block];
    let sum = planes[begin];
    for (let column = 1; column < side; ++column) sum += planes[begin + column];
    sums[block] += sum;
  }
}

// Sums of the blocks of a row, of side x side samples.
function addBlocks(sums, planes, at, stride, begins, side) {
  sums.fill(0);
  for (let row = 0; row < side; ++row) addRow(sums, planes, at + row * stride, begins, side);
}

// Writes a row of R, G, B and 255: full range, BT.601, in numbers of 16 bits behind the point.
function writeRow(pixels, to, {luma, cb, cr}, luma_scale, chroma_scale) {
  for (let column = 0; column < luma.length; ++column, to += 4) {
    const level = luma[column] * luma_scale + 32768;
    const blue = cb[column] * chroma_scale - 128;
    const red = cr[column] * chroma_scale - 128;
    pixels[to] = level + 91881 * red >> 16;
    pixels[to + 1] = level - 22554 * blue - 46802 * red >> 16;
    pixels[to + 2] = level + 116130 * blue >> 16;
    pixels[to + 3] = 255;
  }
}

// Writes the view to `pixels`: means of shrink x shrink px. Blocks never reach into neighbours.
function convertView(planes, place, shrink, pixels) {
  const {stride, tile_size, origin, width} = place;
  const chroma_side = Math.max(1, shrink / 2);
  const begin = (index, start_px, side_px) =>
    Math.min(Math.max(index * shrink - start_px, 0), side_px - shrink);
  const columns = Int32Array.from(
      {length: width}, (_, column) => begin(place.left + column, origin.x, tile_size.width));
  const chroma_columns = columns.map((x) => x >> 1);
  const sums = {luma: new Int32Array(width), cb: new Int32Array(width), cr: new Int32Array(width)};
  for (let row = 0; row < place.height; ++row) {
    const y = begin(place.top + row, origin.y, tile_size.height);
    const chroma = (y >> 1) * (stride / 2);
    addBlocks(sums.luma, planes, place.luma + y * stride, stride, columns, shrink);
    for (const name of ['cb', 'cr']) {
      addBlocks(sums[name], planes, place[name] + chroma, stride / 2, chroma_columns, chroma_side);
    }
    writeRow(pixels, 4 * row * width, sums, 65536 / shrink ** 2, 1 / chroma_side ** 2);
  }
}

export class VideoCanvas {
  #canvas = new OffscreenCanvas(1, 1);
  // The pixels come from this thread.
  #context = this.#canvas.getContext('2d', {alpha: false, willReadFrequently: true});
  #images = new Map();  // of one view, by size: sides differ by a px where tiles end between px
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
      this.#images.clear();
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
    const image = this.#images.get(`${width}x${height}`) ?? new ImageData(width, height);
    this.#images.set(`${width}x${height}`, image);
    convertView(planes, place, shrink, image.data);
    this.#context.putImageData(image, place.left, place.top);
  }
}
