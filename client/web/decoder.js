// SPDX-License-Identifier: Apache-2.0
// Turns atlas messages into bitmaps, one at a time; of those that wait only the newest is decoded.
// Atlases of chained video are all decoded, because each refers to the one before.
import {unpackDepth} from './compact_depth.js';
import {VideoAtlases} from './video_atlas.js';

const kHeaderLengthBytes = 4;

// The decoder of this thread: the page's, or the worker's.
const videos = new VideoAtlases();

// The pictures of a video, which follow each other from `begin` on.
function picturesOf(message, begin, picture_bytes) {
  let at_bytes = begin;
  return picture_bytes.map((size_bytes) => {
    at_bytes += size_bytes;
    return new Uint8Array(message, at_bytes - size_bytes, size_bytes);
  });
}

// message: ArrayBuffer, the length of a JSON header (4 bytes, little-endian), the header, a JPEG or
// the pictures of a video, and 1/Z of its px where that was asked for: float32 in 1/m, or compact.
export function parseAtlasMessage(message) {
  const headerLength = new DataView(message).getUint32(0, true);
  const headerBytes = new Uint8Array(message, kHeaderLengthBytes, headerLength);
  const header = JSON.parse(new TextDecoder().decode(headerBytes));
  const begin = kHeaderLengthBytes + headerLength;
  const {picture_bytes = []} = header;  // none of a JPEG
  const end = picture_bytes.reduce((sum, size_bytes) => sum + size_bytes,
      begin + header.jpeg_bytes);
  return {
    header,
    blob: new Blob([new Uint8Array(message, begin, header.jpeg_bytes)], {type: 'image/jpeg'}),
    pictures: picturesOf(message, begin, picture_bytes),
    depth: header.depth_bands ? [] :
      new Float32Array(message.slice(end, end + header.depth_bytes)),
    packedDepth: new Uint8Array(header.depth_bands ? message.slice(end) : 0),
    bytes: message.byteLength,
  };
}

// {bitmap}, {planes} of a video (video_planes.js), or neither of one that is not to be shown.
async function decodedColor({blob, pictures, layout, link, isBackward, isShown}) {
  if (pictures.length === 0) return {bitmap: await createImageBitmap(blob)};
  const made = await videos.decode(pictures, layout, {link, isBackward, isShown});
  return {...made, upload: videos.upload};
}

// {sequence, reference} of an atlas of chained video; null of others.
function linkOf({sequence, reference_sequence, encoding}) {
  const isChained = encoding?.prediction === 'ACROSS_ATLASES';
  return isChained ? {sequence, reference: reference_sequence} : null;
}

// The same, and `depth` of compact bands alone: {inv_z, columns, rows}.
export async function decoded(job) {
  const {packedDepth, bands, layout: {size, video}} = job;
  const {width} = video?.picture_size ?? size;
  const [made, depth] = await Promise.all([
    decodedColor(job), bands && unpackDepth(packedDepth, bands, width)]);
  return depth ? {...made, depth} : made;
}

// Takes planes back that nobody reads any more.
export function recycle(planes) {
  videos.recycle(planes);
}

export class Decoder {
  #worker = null;
  #decoding = null;
  #waiting = [];    // oldest first
  #isLost = false;  // an atlas that others refer to was not decoded
  #isClosed = false;

  // onDecoded(atlas with bitmap or planes, release() of them, and decode_ms), onDropped(atlas),
  // onVideoFailed(reason): not called where all is asked for as JPEG
  constructor(onDecoded, onDropped, onVideoFailed) {
    this.onDecoded = onDecoded;
    this.onDropped = onDropped;
    this.onVideoFailed = onVideoFailed;
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

  // Nothing comes any more, not even what is being decoded.
  close() {
    this.#isClosed = true;
    this.#waiting = [];
    this.#worker?.terminate();
    this.#worker = null;
  }

  decode(atlas) {
    if (this.#isClosed) return;
    const refers = Boolean(linkOf(atlas.header)?.reference);
    this.#isLost &&= refers;
    if (this.#isLost) {
      this.onDropped(atlas);
      return;
    }
    if (!this.#decoding) {
      this.#start(atlas);
      return;
    }
    if (!refers) {  // it needs none of those that wait
      for (const overtaken of this.#waiting.splice(0)) this.onDropped(overtaken);
    }
    this.#waiting.push(atlas);
  }

  #start(atlas) {
    this.#decoding = atlas;
    const link = linkOf(atlas.header);
    atlas.isOvertaken = this.#waiting.length > 0 && link !== null;
    atlas.decodeStarted_ms = performance.now();
    const {blob, pictures, packedDepth, header} = atlas;
    const job = {blob, pictures, packedDepth, bands: header.depth_bands, layout: header.layout,
      link, isBackward: Boolean(header.is_backward), isShown: !atlas.isOvertaken};
    if (this.#worker) {
      this.#worker.postMessage(job);
    } else {
      decoded(job).then(
          (made) => this.#finish(made), (error) => this.#finish({error: error.message}));
    }
  }

  #finish({error, ...made}) {
    if (this.#isClosed) return;
    const atlas = this.#decoding;
    this.#decoding = null;
    if (error) this.#loseFollowers();
    const next = this.#waiting.shift();
    if (next) this.#start(next);
    if (error) {
      console.warn(`atlas ${atlas.header.sequence} cannot be decoded: ${error}`);
      this.onDropped(atlas);
      if (atlas.pictures.length > 0) this.onVideoFailed(error);
      return;
    }
    if (atlas.isOvertaken) {
      this.onDropped(atlas);
      return;
    }
    Object.assign(atlas, made);
    atlas.release = () => this.#release(made);
    atlas.decode_ms = performance.now() - atlas.decodeStarted_ms;
    this.onDecoded(atlas);
  }

  // Those that wait for what could not be decoded.
  #loseFollowers() {
    while (this.#waiting.length > 0 && linkOf(this.#waiting[0].header)?.reference) {
      this.onDropped(this.#waiting.shift());
    }
    this.#isLost = this.#waiting.length === 0;
  }

  #release({bitmap, planes}) {
    bitmap?.close();
    if (!planes) return;
    if (this.#worker) this.#worker.postMessage({planes}, [planes.buffer]);
    else if (!this.#isClosed) recycle(planes);
  }
}
