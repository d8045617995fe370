// SPDX-License-Identifier: Apache-2.0
// How far the server's clock is ahead of the page's, by answers to clock_probe (proto/web.md).

const kReplyCount = 16;

// Time of the page, as the protocol's messages hold it.
export const nowNs = () => BigInt(Math.round(performance.now() * 1e6));

export class ServerClock {
  #replies = [];  // {ahead_ns: BigInt, error_ns}, the newest last

  // {client_time_ns, server_received_ns, server_sent_ns}: strings
  add(reply, received_ns) {
    const [sent, came, left] = ['client_time_ns', 'server_received_ns', 'server_sent_ns'].map(
        (name) => BigInt(reply[name]));
    const error_ns = Number(received_ns - sent - (left - came)) / 2;
    if (error_ns < 0) return;
    this.#replies.push({ahead_ns: (came + left - sent - received_ns) / 2n, error_ns});
    if (this.#replies.length > kReplyCount) this.#replies.shift();
  }

  forget() { this.#replies = []; }

  // By the answer that came back the soonest; null before the first.
  get ahead_ns() { return this.#soonest?.ahead_ns ?? null; }

  // How long that took on its way there and back, ms; likewise.
  get roundTrip_ms() { return this.#soonest ? 2 * this.#soonest.error_ns / 1e6 : null; }

  get #soonest() {
    return this.#replies.reduce(
        (best, reply) => best && best.error_ns <= reply.error_ns ? best : reply, null);
  }
}

// Nearest value to `value` between both.
const within = (value, least, most) => Math.max(least, Math.min(most, value));

// From the eye's motion to its picture on the screen, ms: {total, to_server, waiting, rendering,
// back}; the parts add up, and none is below 0 however badly the clock is known. eyes, times: of
// the atlas's header; null where nobody knows the clock.
export function motionToPicture({eyes, times}, shown_ns, ahead_ns) {
  if (!eyes || ahead_ns === null || eyes.time_ns === '0') return null;
  const ms = (ns) => Number(ns) / 1e6;
  const measured_ns = BigInt(eyes.time_ns);
  const total = ms(shown_ns - measured_ns);
  const waiting = within(eyes.age_ns / 1e6, 0, total);
  const rendering = within((times.trace_ns + times.encode_ns) / 1e6, 0, total - waiting);
  const travel = total - waiting - rendering;
  const to_server = ms(BigInt(eyes.latched_ns) - ahead_ns - measured_ns) - waiting;
  return {
    total,
    to_server: within(to_server, 0, travel),
    waiting,
    rendering,
    back: travel - within(to_server, 0, travel),
  };
}
