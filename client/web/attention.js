// SPDX-License-Identifier: Apache-2.0
// Whether anybody looks at the page: a display that nobody sees need not be traced.

const kHiddenGrace_ms = 5000;

// onRest(): nobody has looked for a while; onLook(): somebody does again; onTurn(): either begins
export function watchAttention({onRest, onLook, onTurn}) {
  let timer = 0;
  document.addEventListener('visibilitychange', () => {
    clearTimeout(timer);
    onTurn();
    if (document.hidden) timer = setTimeout(onRest, kHiddenGrace_ms);
    else onLook();
  });
  // Browsers keep a page that was left, with its connection but no timers, for when one goes back.
  addEventListener('pagehide', onRest);
}
