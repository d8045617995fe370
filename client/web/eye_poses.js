// SPDX-License-Identifier: Apache-2.0
// Eye poses on their way to the server: the newest only, and what became of them.
import {motionToPicture, nowNs, ServerClock} from './server_clock.js';

const kProbe_ms = 1000;
const kRemembered = 256;  // poses: four seconds of them
const kSmoothing = 0.15;  // weight of the newest picture in a running mean

export class EyePoses {
  #send;
  #clock = new ServerClock();
  #sent = new Map();  // by time_ns: what the sender noted beside it
  #newest = '';       // the newest, as text
  #newest_ns = null;
  #shown_ns = null;   // of the poses of the newest picture on the screen
  #probed_ms = -Infinity;
  #means = null;

  // send(message): whether it went
  constructor(send) {
    this.#send = send;
  }

  // Another connection knows no poses, and perhaps another clock.
  restart() {
    this.#newest = '';
    this.#newest_ns = this.#shown_ns = null;
    this.#sent.clear();
    this.#clock.forget();
    this.#means = null;
  }

  // eyes: Cameras of the protocol; note: comes back with their picture. Whether they are others
  // than before, and went.
  put(eyes, note) {
    const text = JSON.stringify(eyes);
    // JSON has no word for what is no number.
    if (text === this.#newest || text.includes('null')) return false;
    const time_ns = String(nowNs());
    if (!this.#send({eye_poses: {time_ns, eyes}})) return false;
    this.#newest = text;
    this.#newest_ns = time_ns;
    this.#sent.set(time_ns, note);
    if (this.#sent.size > kRemembered) this.#sent.delete(this.#sent.keys().next().value);
    return true;
  }

  // Whether none went over this connection yet.
  get isFresh() { return this.#newest_ns === null; }

  // The note beside the poses that an atlas shows; undefined for none of this connection.
  noteOf({eyes}) { return eyes && this.#sent.get(eyes.time_ns); }

  // Whether an atlas shows the newest poses.
  isNewest({eyes}) { return (eyes?.time_ns ?? null) === this.#newest_ns; }

  // An atlas is on the screen. Only the first one of its poses answers a motion: while the eye
  // stands, the scene goes on.
  shown(header) {
    const shown_ns = nowNs();
    if (!this.noteOf(header) || header.eyes.time_ns === this.#shown_ns) return;
    this.#shown_ns = header.eyes.time_ns;
    this.#send({presented: {sequence: String(header.sequence),
      presented_time_ns: String(shown_ns)}});
    const parts = motionToPicture(header, shown_ns, this.#clock.ahead_ns);
    if (!parts) return;
    this.#means ??= parts;
    for (const [name, value] of Object.entries(parts)) {
      this.#means[name] += (value - this.#means[name]) * kSmoothing;
    }
  }

  // Asks for the server's clock now and then: to be called several times a second.
  probe(now_ms) {
    if (now_ms - this.#probed_ms < kProbe_ms) return;
    this.#probed_ms = now_ms;
    this.#send({clock_probe: {client_time_ns: String(nowNs())}});
  }

  takeClock(reply) { this.#clock.add(reply, nowNs()); }

  // How long a message takes to the server and back, ms; null while nobody knows.
  get line_ms() { return this.#clock.roundTrip_ms; }

  // Motion to picture and its parts, ms; null while nobody knows.
  get latency() { return this.#means; }
}

// "motion to picture 52 ms: 1 to the server, 4 waiting, 38 rendering, 9 back"
export function latencyText(latency) {
  if (!latency) return '–';
  const [total, toServer, waiting, rendering, back] =
      ['total', 'to_server', 'waiting', 'rendering', 'back'].map(
          (name) => latency[name].toFixed(0));
  return `${total} ms: ${toServer} to the server, ${waiting} waiting, ${rendering} rendering, ` +
      `${back} back`;
}
