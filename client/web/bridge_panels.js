// SPDX-License-Identifier: Apache-2.0
// Panels that Looking Glass Bridge on this machine knows, by its documented HTTP interface.

// The one address beside its own server that the page may ask: the content security policy of
// server/web/routes.cpp names it, too.
const kBridge = 'http://localhost:33334';
const kAnswer_ms = 5000;
const kOrchestration = 'viewloom-page';
const kInstead = 'Drop visual.json here instead.';

// Bridge wraps values as {"name": ..., "value": VALUE}.
const unwrapped = (wrapped) => wrapped && typeof wrapped === 'object' && 'value' in wrapped ?
  wrapped.value : wrapped;

async function exchange(endpoint, fields) {
  try {
    const reply = await fetch(`${kBridge}/${endpoint}`, {
      method: 'PUT',
      headers: {'Content-Type': 'application/json'},
      body: JSON.stringify(fields),
      signal: AbortSignal.timeout(kAnswer_ms),
    });
    return {status: reply.status, text: await reply.text()};
  } catch {
    throw new Error(`No Bridge answers at ${kBridge}. Start Looking Glass Bridge on this machine ` +
                    `and let this page reach it where the browser asks. ${kInstead}`);
  }
}

// The payload's value. Throws an Error with one sentence.
async function call(endpoint, fields) {
  const {status, text} = await exchange(endpoint, fields);
  let answer = null;
  try {
    answer = JSON.parse(text);
  } catch {
    // told below: Bridge answers with an empty body to what it does not know
  }
  const isDone = status === 200 && unwrapped(answer?.status) === 'Completion';
  if (isDone) return unwrapped(answer.payload);
  throw new Error(`${kBridge} answered ${endpoint} with status ${status} and ` +
                  `${text.length} bytes that are no answer of Bridge. Update Looking Glass ` +
                  `Bridge. ${kInstead}`);
}

// Ordinary monitors are listed as well, without a calibration.
function panelOf(wrapped) {
  const device = unwrapped(wrapped);
  const calibration = unwrapped(device?.calibration);
  if (typeof calibration !== 'string' || calibration === '') return null;
  return {name: String(unwrapped(device.hwid) || 'a panel without a name'), calibration};
}

// The panels: {name, calibration}, the latter the text of a visual.json. Throws an Error with one
// sentence where there is no Bridge, or none of its displays is a panel.
export async function askPanels() {
  const orchestration = await call('enter_orchestration', {name: kOrchestration});
  try {
    const devices = await call('available_output_devices', {orchestration});
    const panels = Object.values(devices ?? {}).map(panelOf).filter((panel) => panel !== null);
    if (panels.length > 0) return panels;
  } finally {
    await call('exit_orchestration', {orchestration}).catch(() => {});
  }
  throw new Error(`Bridge finds no panel. Check its cables for video and USB. ${kInstead}`);
}
