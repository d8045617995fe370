// SPDX-License-Identifier: Apache-2.0
// Turns atlas messages into bitmaps, one at a time; of those that wait only the newest is decoded.

const kHeaderLengthBytes = 4;

// message: ArrayBuffer, the length of a JSON header (4 bytes, little-endian), the header, a JPEG,
// and 1/Z of its px where that was asked for, float32 in 1/m.
export function parseAtlasMessage(message) {
  const headerLength = new DataView(message).getUint32(0, true);
  const headerBytes = new Uint8Array(message, kHeaderLengthBytes, headerLength);
  const header = JSON.parse(new TextDecoder().decode(headerBytes));
  const begin = kHeaderLengthBytes + headerLength;
  const end = begin + header.jpeg_bytes;
  return {
    header,
    blob: new Blob([new Uint8Array(message, begin, header.jpeg_bytes)], {type: 'image/jpeg'}),
    depth: new Float32Array(message.slice(end, end + header.depth_bytes)),
    bytes: message.byteLength,
  };
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
      this.#worker = new Worker('decode_worker.js');
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
    if (this.#worker) {
      this.#worker.postMessage(atlas.blob);
    } else {
      createImageBitmap(atlas.blob).then(
          (bitmap) => this.#finish({bitmap}), (error) => this.#finish({error: String(error)}));
    }
  }

  #finish({bitmap, error}) {
    const atlas = this.#decoding;
    this.#decoding = null;
    if (this.#waiting) {
      const next = this.#waiting;
      this.#waiting = null;
      this.#start(next);
    }
    if (error) {
      console.warn(`atlas ${atlas.header.sequence} is no JPEG: ${error}`);
      this.onDropped(atlas);
      return;
    }
    atlas.bitmap = bitmap;
    atlas.decode_ms = performance.now() - atlas.decodeStarted_ms;
    this.onDecoded(atlas);
  }
}
