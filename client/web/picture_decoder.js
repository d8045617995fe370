// SPDX-License-Identifier: Apache-2.0
// Decodes one stream of H.264 by WebCodecs, and hands out its pictures in order.

const kPatience_ms = 8000;  // a decoder that gives nothing for as long hangs
// A decoder that may not be asked for what it keeps has given each picture by then.
const kFollowing_ms = 2000;

// Frames in the order in which the decoder gives them, for one reader.
class FrameQueue {
  #frames = [];
  #wake = null;
  #failure = null;
  #isOver = false;

  constructor(patience_ms) {
    this.patience_ms = patience_ms;
  }

  push(frame) {
    if (this.#isOver) {
      frame.close();
      return;
    }
    this.#frames.push(frame);
    this.#wake?.();
  }

  fail(error) {
    this.#failure ??= error;
    this.#wake?.();
  }

  // The next frame; throws what failed.
  async next() {
    const timer = setTimeout(
        () => this.fail(new Error('the decoder gives no picture')), this.patience_ms);
    try {
      while (this.#frames.length === 0) {
        if (this.#failure) throw this.#failure;
        await new Promise((resolve) => { this.#wake = resolve; });
        this.#wake = null;
      }
      return this.#frames.shift();
    } finally {
      clearTimeout(timer);
    }
  }

  // Closes what is left, and what still comes.
  end() {
    this.#isOver = true;
    for (const frame of this.#frames.splice(0)) frame.close();
  }
}

export class PictureDecoder {
  #decoder = null;
  #configuration = '';  // as text
  #frames = null;       // of the atlas that is being decoded
  #timestamp_us = 0;    // of the next picture
  #timer = 0;

  // patience_ms: with one that gives no picture
  constructor(patience_ms = kPatience_ms) {
    this.patience_ms = patience_ms;
  }

  // An atlas begins. configuration: VideoDecoderConfig
  begin(configuration) {
    this.#frames = new FrameQueue(this.patience_ms);
    const text = JSON.stringify(configuration);
    if (this.#decoder?.state === 'configured' && text === this.#configuration) return;
    if (!this.#decoder || this.#decoder.state === 'closed') {
      this.#decoder = new VideoDecoder({
        output: (frame) => this.#frames.push(frame),
        error: (error) => this.#frames.fail(error),
      });
    }
    this.#decoder.configure(configuration);
    this.#configuration = text;
  }

  // data: an access unit, Uint8Array
  feed(data, isKey) {
    this.#decoder.decode(new EncodedVideoChunk(
        {type: isKey ? 'key' : 'delta', timestamp: this.#timestamp_us++, data}));
  }

  // The atlas has no more pictures. The next one has to begin with a key picture: decoders may keep
  // pictures until they are flushed.
  flush() {
    const frames = this.#frames;
    this.#decoder.flush().then(
        () => frames.fail(new Error('the decoder gave fewer pictures than came')),
        (error) => frames.fail(error));
  }

  // The same, but the next one may refer to it.
  expectAll() {
    const frames = this.#frames;
    this.#timer = setTimeout(
        () => frames.fail(new Error('the decoder keeps pictures back')), kFollowing_ms);
  }

  // The next frame of the atlas, to be closed; throws what failed.
  next() { return this.#frames.next(); }

  // Closes the frames of the atlas that nobody took.
  end() {
    clearTimeout(this.#timer);
    this.#frames?.end();
  }

  close() {
    this.end();
    if (this.#decoder && this.#decoder.state !== 'closed') this.#decoder.close();
    this.#decoder = null;
  }
}
