// SPDX-License-Identifier: Apache-2.0
// Turns atlas messages into bitmaps, one at a time; of those that wait only the newest is decoded.
import {unpackDepth} from './compact_depth.js';

const kHeaderLengthBytes = 4;

// message: ArrayBuffer, the length of a JSON header (4 bytes, little-endian), the header, a JPEG,
// and 1/Z of its px where that was asked for: float32 in 1/m, or compact.
export function parseAtlasMessage(message) {
  const headerLength = new DataView(message).getUint32(0, true);
  const headerBytes = new Uint8Array(message, kHeaderLengthBytes, headerLength);
  const header = JSON.parse(new TextDecoder().decode(headerBytes));
  const begin = kHeaderLengthBytes + headerLength;
  const end = begin + header.jpeg_bytes;
  return {
    header,
    blob: new Blob([new Uint8Array(message, begin, header.jpeg_bytes)], {type: 'image/jpeg'}),
    depth: header.depth_bands ? [] :
      new Float32Array(message.slice(end, end + header.depth_bytes)),
    packedDepth: new Uint8Array(header.depth_bands ? message.slice(end) : 0),
    bytes: message.byteLength,
  };
}

// {bitmap, depth}: depth of compact bands alone, {inv_z, columns, rows}.
export async function decoded({blob, packedDepth, bands, width_px}) {
  const [bitmap, depth] = await Promise.all([
    createImageBitmap(blob), bands && unpackDepth(packedDepth, bands, width_px)]);
  return {bitmap, depth};
}

export class Decoder {
  #worker = null;
  #decoding = null;
  #waiting = null;

  // onDecoded(atlas with bitmap and decode_ms), onDropped(atlas)
  constructor(onDecoded, onDropped) {
    this.onDecoded = onDecoded;
    this.onDropped = onDropped;
    try {
      this.#worker = new Worker('decode_worker.js', {type: 'module'});
      this.#worker.onmessage = ({data}) => this.#finish(data);
      this.#worker.onerror = (event) => {  // no workers here: decode on this thread
        event.preventDefault();
        this.#worker = null;
        if (this.#decoding) this.#start(this.#decoding);
      };
    } catch {
      this.#worker = null;
    }
  }

  decode(atlas) {
    if (this.#decoding) {
      if (this.#waiting) this.onDropped(this.#waiting);
      this.#waiting = atlas;
    } else {
      this.#start(atlas);
    }
  }

  #start(atlas) {
    this.#decoding = atlas;
    atlas.decodeStarted_ms = performance.now();
    const {blob, packedDepth, header} = atlas;
    const job = {blob, packedDepth, bands: header.depth_bands, width_px: header.layout.size.width};
    if (this.#worker) {
      this.#worker.postMessage(job);
    } else {
      decoded(job).then(
          (made) => this.#finish(made), (error) => this.#finish({error: String(error)}));
    }
  }

  #finish({bitmap, depth, error}) {
    const atlas = this.#decoding;
    this.#decoding = null;
    if (this.#waiting) {
      const next = this.#waiting;
      this.#waiting = null;
      this.#start(next);
    }
    if (error) {
      console.warn(`atlas ${atlas.header.sequence} cannot be decoded: ${error}`);
      this.onDropped(atlas);
      return;
    }
    atlas.bitmap = bitmap;
    if (depth) atlas.depth = depth;
    atlas.decode_ms = performance.now() - atlas.decodeStarted_ms;
    this.onDecoded(atlas);
  }
}
