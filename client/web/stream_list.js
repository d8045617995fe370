// SPDX-License-Identifier: Apache-2.0
// Which streams there are, asked for again and again.
import {enter} from './sign_in.js';

const kPoll_ms = 1000;
const kAnswer_ms = 5000;
const kUnauthorized = 401;

const byId = (id) => document.getElementById(id);
const label = ({name, live}) => live ? name : `${name} (still)`;

export class StreamList {
  #publishing = true;  // whether the watched stream's publisher was there when last asked

  // Handlers: asked() = the name wished for, or null; watching() = the name watched, or null;
  // onFound(name) while nothing is watched; onNone(); onPublisher(isThere); onSilence()
  constructor(handlers) {
    this.handlers = handlers;
  }

  // Another stream is watched.
  restart() {
    this.#publishing = true;
  }

  // The one asked for, else the first that is live, else the first.
  async poll() {
    try {
      const signal = AbortSignal.timeout(kAnswer_ms);
      const reply = await fetch('api/streams', {cache: 'no-store', signal});
      if (reply.status === kUnauthorized) {
        await enter();
        return;
      }
      const {streams} = await reply.json();
      const found = streams.find(({name}) => name === this.handlers.asked()) ??
          streams.find(({live}) => live) ?? streams[0];
      if (!this.handlers.watching()) {
        if (found) this.handlers.onFound(found.name);
        else this.handlers.onNone();
      }
      this.#show(streams);
      this.#notePublisher(streams.find(({name}) => name === this.handlers.watching()));
    } catch {
      this.handlers.onSilence();
    } finally {
      setTimeout(() => this.poll(), kPoll_ms);
    }
  }

  #show(streams) {
    const select = byId('stream');
    const wanted = streams.map(label).join('\n');
    if (select.dataset.shown !== wanted) {
      select.dataset.shown = wanted;
      select.replaceChildren(...streams.map((entry) => new Option(label(entry), entry.name)));
    }
    select.disabled = streams.length === 0;
    if (this.handlers.watching()) select.value = this.handlers.watching();
  }

  #notePublisher(entry) {
    if (!entry || entry.live === this.#publishing) return;
    this.#publishing = entry.live;
    this.handlers.onPublisher(entry.live);
  }
}
