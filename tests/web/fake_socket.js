// SPDX-License-Identifier: Apache-2.0
// Put into the page before its scripts: a WebSocket without a server. It sends the atlases of the
// list window.wanted (paths). window.asked keeps its addresses, window.said what the page says.
// If window.isFlood, the list goes round, and an atlas follows each one that is shown, as of a
// server that is never waited for.
window.wanted = [];
window.said = [];
window.asked = [];
const kept = new Map();  // atlases by path

window.WebSocket = class extends EventTarget {
  static OPEN = 1;
  readyState = 0;
  #changes = 0;

  constructor(url) {
    super();
    window.asked.push(String(url));
    window.socket = this;
    setTimeout(() => {
      this.readyState = 1;
      this.onopen?.();
      this.deliver();
      if (window.isFlood) this.deliver();
    }, 0);
  }

  send(text) {
    const message = JSON.parse(text);
    window.said.push(message);
    if (message.ping) this.onmessage?.({data: JSON.stringify({pong: message.ping})});
    if (message.shown && window.isFlood) this.deliver();
    if (message.change) {
      this.#changes++;
      window.onChange?.(message.change);
      this.deliver();
    }
  }

  close() { this.readyState = 3; }

  // The next atlas of the list; the last one stays.
  async deliver() {
    const path = window.wanted.length > 1 ? window.wanted.shift() : window.wanted[0];
    if (!path) return;
    if (window.isFlood) window.wanted.push(path);
    if (!kept.has(path)) kept.set(path, await (await fetch(path)).arrayBuffer());
    this.onmessage?.({data: kept.get(path).slice(0)});
  }
};
