// SPDX-License-Identifier: Apache-2.0
// Which streams there are, asked for again and again.
import {allow} from './allowed.js';
import {enter} from './sign_in.js';

const kPoll_ms = 1000;
const kAnswer_ms = 5000;
const kUnauthorized = 401;
// A stream that is not there yet is looked for so long: a publisher needs some time to start.
const kMissing_ms = 60_000;

const byId = (id) => document.getElementById(id);
const label = ({name, live}) => live ? name : `${name} (still)`;

export class StreamList {
  #publishing = true;  // whether the watched stream's publisher was there when last asked

  #missing_ms = null;  // since when the wished stream was looked for
  #isLooking = true;

  // Handlers: asked() = the name wished for, or null; watching() = the name watched, or null;
  // onFound(name) while nothing is watched; onNone(); onMissing(name, names of those that are
  // there, whether it is looked for again); onPublisher(isThere); onSilence()
  constructor(handlers) {
    this.handlers = handlers;
    allow(byId('stream'), 'The server has not said yet which streams there are.');
  }

  // Looks for the wished stream once more.
  lookAgain() {
    this.#missing_ms = null;
    this.poll();
  }

  // Another stream is watched.
  restart() {
    this.#publishing = true;
    if (!this.#isLooking) this.lookAgain();
  }

  // The one asked for; if none is, the first that is live, else the first.
  async poll() {
    this.#isLooking = true;
    try {
      const signal = AbortSignal.timeout(kAnswer_ms);
      const reply = await fetch('api/streams', {cache: 'no-store', signal});
      if (reply.status === kUnauthorized) {
        await enter();
        return;
      }
      const {streams} = await reply.json();
      if (!this.handlers.watching()) this.#isLooking = this.#find(streams);
      this.#show(streams);
      this.#notePublisher(streams.find(({name}) => name === this.handlers.watching()));
    } catch {
      this.handlers.onSilence();
    } finally {
      if (this.#isLooking) setTimeout(() => this.poll(), kPoll_ms);
    }
  }

  // Nothing is watched. Whether it is worth looking again.
  #find(streams) {
    const wished = this.handlers.asked();
    const found = wished ? streams.find(({name}) => name === wished) :
      streams.find(({live}) => live) ?? streams[0];
    if (found) {
      this.handlers.onFound(found.name);
      return true;
    }
    if (!wished) {
      this.handlers.onNone();
      return true;
    }
    this.#missing_ms ??= performance.now();
    const isLooking = performance.now() - this.#missing_ms < kMissing_ms;
    this.handlers.onMissing(wished, streams.map(({name}) => name), isLooking);
    return isLooking;
  }

  #show(streams) {
    const select = byId('stream');
    const wanted = streams.map(label).join('\n');
    if (select.dataset.shown !== wanted) {
      select.dataset.shown = wanted;
      select.replaceChildren(...streams.map((entry) => new Option(label(entry), entry.name)));
    }
    allow(select, streams.length === 0 ? 'No stream is live: there is nothing to choose.' : '');
    select.value = this.handlers.watching() ?? '';
  }

  #notePublisher(entry) {
    if (!entry || entry.live === this.#publishing) return;
    this.#publishing = entry.live;
    this.handlers.onPublisher(entry.live);
  }
}
