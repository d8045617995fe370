// SPDX-License-Identifier: Apache-2.0
// A connection to the server that comes back by itself, also when it dies without a word.
import {askedPath} from './address.js';
import {parseAtlasMessage} from './decoder.js';

// A server that is there again has its viewers back soon after: each tries once a second or more.
const kRetryFirst_ms = 300;
const kRetryMax_ms = 1000;
const kConnect_ms = 5000;        // a server that is there has answered by then
const kQuiet_ms = 2000;          // after so long without a message, the server is asked for one
const kSilenceFirst_ms = 10_000;  // and after so long the connection is dead
// One large picture may take a slow network longer: then the next connection is given more time.
const kSilenceMax_ms = 160_000;
const kTick_ms = 500;
// A stream that never was there may come soon: a publisher needs some time to start.
const kMissing_ms = 60_000;
// Refusals that no waiting changes.
const kLasting = ['INVALID_ARGUMENT', 'OUT_OF_RANGE', 'PERMISSION_DENIED', 'UNIMPLEMENTED'];
const kRefused = 1008;  // close code

export class AtlasStream {
  #socket = null;
  #timer = 0;
  #listening = 0;  // timer
  #failures = 0;
  #heard_ms = 0;  // when the newest message came
  #asked_ms = 0;  // when the newest question for one went
  #silence_ms = kSilenceFirst_ms;
  #isClosed = true;
  #refusal = null;     // the newest over this connection
  #missing_ms = null;  // since when the server knows no such stream
  #known = '';         // the newest stream that gave a picture
  #changeCount = 0;  // changes sent over this connection

  // Handlers: onAtlas(atlas), onLive(), onAsked() for another picture, onWaiting(reason),
  // onRefused(error), onGivenUp(error): it will not be tried again, onClock(the answer to a
  // clock_probe)
  constructor(handlers) {
    this.handlers = handlers;
  }

  // asked: {stream, display, encoding}, the latter messages as JSON
  open(asked) {
    this.close();
    this.asked = asked;
    this.#isClosed = false;
    this.#failures = 0;
    this.#missing_ms = null;
    this.#listening = setInterval(() => this.#listen(), kTick_ms);
    addEventListener('online', this.#hurry);
    this.#connect();
  }

  close() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    clearInterval(this.#listening);
    removeEventListener('online', this.#hurry);
    this.#isClosed = true;
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
  }

  // The delivery is on the screen, or was dropped: there is room for another.
  shown(delivery) {
    this.send({shown: delivery});
  }

  // Display and encoding as they shall be from now on, and after a reconnection. Whether the server
  // was asked: not where both are as they shall be, or it is not there.
  change(asked) {
    const change = {};
    for (const part of ['display', 'encoding']) {
      if (JSON.stringify(asked[part]) !== JSON.stringify(this.asked[part])) {
        change[part] = asked[part];
      }
    }
    this.asked = asked;
    if (Object.keys(change).length === 0 || !this.send({change})) return false;
    this.#changeCount++;
    this.handlers.onAsked();
    return true;
  }

  // Whether the server is there. What came from it before may still be decoded.
  get isOpen() { return this.#socket?.readyState === WebSocket.OPEN; }

  // Whether an atlas came of all that was asked for.
  isNewest(atlas) {
    return atlas.header.change_count >= this.#changeCount;
  }

  // A ViewerMessage (proto/web.md). Whether it went.
  send(message) {
    if (!this.isOpen) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #connect() {
    const url = new URL(askedPath(this.asked), location.href);
    url.protocol = url.protocol.replace('http', 'ws');
    const socket = new WebSocket(url);
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    this.#changeCount = 0;
    this.#refusal = null;
    this.#heard_ms = performance.now();
    let opened = false;
    socket.onopen = () => {
      if (this.#socket !== socket) return;
      opened = true;
      this.#failures = 0;
      this.#heard_ms = performance.now();
      this.handlers.onLive();
      this.handlers.onAsked();
    };
    socket.onmessage = ({data}) => {
      if (this.#socket !== socket) return;
      this.#heard_ms = performance.now();
      this.#silence_ms = kSilenceFirst_ms;
      if (typeof data === 'string') {
        this.#takeText(JSON.parse(data));
        return;
      }
      this.#known = this.asked.stream;
      this.handlers.onAtlas(parseAtlasMessage(data));
    };
    socket.onclose = ({code}) => {
      if (this.#socket !== socket) return;
      this.#socket = null;
      this.#retry(opened, code);
    };
  }

  #takeText({error, clock}) {
    if (clock) this.handlers.onClock?.(clock);
    if (!error) return;
    this.#refusal = error;
    this.handlers.onRefused(error);
  }

  // Whether another try may bring what this one did not. A stream that was there comes back.
  #mayPass({code}) {
    if (kLasting.includes(code)) return false;
    if (code !== 'NOT_FOUND' || this.asked.stream === this.#known) return true;
    this.#missing_ms ??= performance.now();
    return performance.now() - this.#missing_ms < kMissing_ms;
  }

  #giveUp(error) {
    this.close();
    this.handlers.onGivenUp(error);
  }

  // A server on another machine may go, and a network on the way, without a word: browsers say
  // nothing of that for minutes.
  #listen() {
    const socket = this.#socket;
    if (!socket) return;
    const now_ms = performance.now();
    const silent_ms = now_ms - this.#heard_ms;
    const isOpen = socket.readyState === WebSocket.OPEN;
    if (silent_ms > (isOpen ? this.#silence_ms : kConnect_ms)) {
      this.#silence_ms = Math.min(2 * this.#silence_ms, kSilenceMax_ms);
      this.#abandon(isOpen);
    } else if (isOpen && silent_ms > kQuiet_ms && now_ms - this.#asked_ms > kQuiet_ms) {
      this.#asked_ms = now_ms;
      this.send({ping: Math.round(now_ms)});
    }
  }

  #abandon(opened) {
    const socket = this.#socket;
    this.#socket = null;
    socket.close();
    this.#retry(opened, 0);
  }

  // There is a network again: what was open before it went is not trusted, nothing is waited for.
  #hurry = () => {
    if (this.#socket) {
      this.#abandon(true);
    } else if (this.#timer) {
      clearTimeout(this.#timer);
      this.#connect();
    }
  };

  async #retry(opened, code) {
    // Pages may not read why an upgrade was refused; a plain request to the same URL tells.
    let reason = code === 1001 ? 'The server is going away.' : 'The connection was lost.';
    if (code === kRefused && this.#refusal && !this.#mayPass(this.#refusal)) {
      this.#giveUp(this.#refusal);
      return;
    }
    if (code === kRefused && this.#refusal) reason = this.#refusal.message;
    if (!opened) {
      const signal = AbortSignal.timeout(kConnect_ms);
      const refusal = await fetch(askedPath(this.asked), {signal})
          .then((reply) => reply.status === 426 ? null : reply.json()).catch(() => null);
      if (this.#socket || this.#isClosed) return;
      if (refusal?.error) {
        if (!this.#mayPass(refusal.error)) {
          this.#giveUp(refusal.error);
          return;
        }
        this.handlers.onRefused(refusal.error);
      }
      reason = refusal?.error?.message ?? 'The server does not answer.';
    }
    const longest_ms = Math.min(kRetryMax_ms, kRetryFirst_ms * 2 ** this.#failures++);
    const retry_ms = longest_ms * (0.5 + Math.random() / 2);
    this.handlers.onWaiting(reason);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.#connect();
    }, retry_ms);
  }
}
