// SPDX-License-Identifier: Apache-2.0
// A connection to the server that comes back by itself.
import {parseAtlasMessage} from './decoder.js';

const kRetryFirst_ms = 500;
const kRetryMax_ms = 10_000;

export class AtlasStream {
  #socket = null;
  #timer = 0;
  #failures = 0;

  // Handlers: onAtlas(atlas), onLive(), onAsked() for another picture, onWaiting({message,
  // retry_ms}), onRefused(error)
  constructor(handlers) {
    this.handlers = handlers;
  }

  // parameters: URLSearchParams, as /ws takes them
  open(parameters) {
    this.close();
    this.parameters = parameters;
    this.#failures = 0;
    this.#connect();
  }

  close() {
    clearTimeout(this.#timer);
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
  }

  // The delivery is on the screen, or was dropped: there is room for another.
  shown(delivery) {
    this.#send({shown: delivery});
  }

  // Parameters as they shall be from now on, and after a reconnection; null = the default.
  change(parameters) {
    for (const [name, value] of Object.entries(parameters)) {
      if (value === null) this.parameters.delete(name);
      else this.parameters.set(name, value);
    }
    if (this.#send({change: parameters})) this.handlers.onAsked();
  }

  #send(message) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #connect() {
    const url = new URL(`/ws?${this.parameters}`, location.href);
    url.protocol = url.protocol.replace('http', 'ws');
    const socket = new WebSocket(url);
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    let opened = false;
    socket.onopen = () => {
      if (this.#socket !== socket) return;
      opened = true;
      this.#failures = 0;
      this.handlers.onLive();
      this.handlers.onAsked();
    };
    socket.onmessage = ({data}) => {
      if (this.#socket !== socket) return;
      if (typeof data === 'string') this.handlers.onRefused(JSON.parse(data).error);
      else this.handlers.onAtlas(parseAtlasMessage(data));
    };
    socket.onclose = ({code}) => {
      if (this.#socket !== socket) return;
      this.#socket = null;
      this.#retry(opened, code);
    };
  }

  async #retry(opened, code) {
    // Pages may not read why an upgrade was refused; a plain request to the same URL tells.
    let reason = code === 1001 ? 'The server is going away.' : 'The connection was lost.';
    if (!opened) {
      const refusal = await fetch(`/ws?${this.parameters}`).then(
          (reply) => reply.status === 426 ? null : reply.json(), () => null);
      if (this.#socket) return;
      if (refusal?.error) this.handlers.onRefused(refusal.error);
      reason = refusal?.error?.message ?? 'The server does not answer.';
    }
    const longest_ms = Math.min(kRetryMax_ms, kRetryFirst_ms * 2 ** this.#failures++);
    const retry_ms = longest_ms * (0.5 + Math.random() / 2);
    this.handlers.onWaiting({message: reason, retry_ms});
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#connect(), retry_ms);
  }
}
