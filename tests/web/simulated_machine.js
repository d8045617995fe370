// SPDX-License-Identifier: Apache-2.0
// A machine whose speed is known, for the policy of automatic detail to find. In simulated time.

// machine: fixed_ms an atlas costs whatever its size, full_ms at full detail beyond that; others_ms
// the server does something else before each;
// published_hz; noise: share by which a cost varies; stall: chance that an atlas takes 400 ms more;
// pauses: [begin_s, end_s] without frames; changes: [[time_s, {fields of machine}]], in order.
// Returns the details chosen, [{time_s, detail}], and the atlases shown, [{time_s, detail}].
function simulate(AutoDetail, machine, seconds) {
  const usual = {fixed_ms: 10, full_ms: 100, others_ms: 0, published_hz: 15, noise: 0, stall: 0};
  let state = {...usual, ...machine};
  const changes = [...(machine.changes ?? [])];
  const [pauseBegin_s, pauseEnd_s] = machine.pause ?? [Infinity, Infinity];
  let seed = 12345;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const chosen = [];
  const shown = [];
  let time_ms = 0, frame = 0, nextFrame_ms = 0;
  const policy = new AutoDetail(() => chosen.push({time_s: time_ms / 1000, detail: policy.detail}));
  chosen.push({time_s: 0, detail: policy.detail});
  const publishUntil = (end_ms) => {
    while (nextFrame_ms <= end_ms) {
      const isPaused = nextFrame_ms >= pauseBegin_s * 1000 && nextFrame_ms < pauseEnd_s * 1000;
      if (!isPaused) ++frame;
      nextFrame_ms += 1000 / state.published_hz;
    }
  };
  let shownFrame = 0;
  let queued = policy.detail;  // what the server traces with: one atlas behind
  let shownDetail = null;
  let nextLook_ms = 0;
  const lookUntil = (end_ms) => {
    for (; nextLook_ms <= end_ms; nextLook_ms += 250) policy.look(nextLook_ms);
  };
  while (time_ms < seconds * 1000) {
    if (changes.length && time_ms >= changes[0][0] * 1000) {
      state = {...state, ...changes.shift()[1]};
    }
    publishUntil(time_ms);
    // Another detail is traced of the frame that is there.
    while (frame === shownFrame && queued === shownDetail && time_ms < seconds * 1000) {
      time_ms = Math.min(nextFrame_ms, nextLook_ms);
      lookUntil(time_ms);
      publishUntil(time_ms);
      queued = policy.detail;
    }
    shownFrame = frame;
    shownDetail = queued;
    const detail = queued;
    queued = policy.detail;
    const noise = 1 + state.noise * (2 * random() - 1);
    const traced_ms = state.full_ms * detail ** 2 * noise;
    time_ms += state.others_ms + state.fixed_ms + traced_ms + (random() < state.stall ? 400 : 0);
    shown.push({time_s: time_ms / 1000, detail});
    const side = Math.round(3360 * detail);
    lookUntil(time_ms);
    policy.note({
      frame_number: String(shownFrame),
      layout: {size: {width: side, height: side}},
      times: {retime_ns: 0, upload_ns: 0, build_ns: state.fixed_ms * 1e6,
              trace_ns: traced_ms * 1e6, encode_ns: 0},
    }, time_ms);
  }
  return {chosen, shown};
}
