// SPDX-License-Identifier: Apache-2.0
// Keys that press buttons, and the list of them under '?'.

const kActions = {};
const byId = (id) => document.getElementById(id);

// A line of the list: keys as a reader calls them, and what they do.
export function describeKey(keys, text) {
  const name = document.createElement('kbd');
  name.textContent = keys;
  const term = document.createElement('dt');
  term.append(name);
  const meaning = document.createElement('dd');
  meaning.textContent = text;
  byId('key-list').append(term, meaning);
}

// By one key, unless something is typed. text: what it does, for the list; '' = not in it.
export function onKey(key, action, text = '') {
  kActions[key] = action;
  if (text) describeKey(key.toUpperCase(), text);
}

// onSwitch(isOn); text: as onKey() takes it
export function toggle(button, key, onSwitch, text = '') {
  const flip = () => {
    if (button.disabled) return;
    const isOn = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', isOn);
    onSwitch(isOn);
  };
  button.addEventListener('click', flip);
  onKey(key, flip, text);
}

document.addEventListener('keydown', (event) => {
  const isTyped = event.target.matches('select, textarea, input:not([type=range], [type=radio])');
  if (event.ctrlKey || event.altKey || event.metaKey || isTyped) return;
  if (byId('keys').open && event.key !== '?') return;
  kActions[event.key.toLowerCase()]?.();
});

function showKeys() {
  if (byId('keys').open) byId('keys').close();
  else byId('keys').showModal();
}

onKey('?', showKeys, 'this list');
byId('show-keys').addEventListener('click', showKeys);
byId('keys-close').addEventListener('click', () => byId('keys').close());
