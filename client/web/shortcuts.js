// SPDX-License-Identifier: Apache-2.0
// Buttons that are switched on and off, and keys that press them.

const kActions = {};

// By one key, unless something is typed.
export function onKey(key, action) {
  kActions[key] = action;
}

// onSwitch(isOn)
export function toggle(button, key, onSwitch) {
  const flip = () => {
    const isOn = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', isOn);
    onSwitch(isOn);
  };
  button.addEventListener('click', flip);
  onKey(key, flip);
}

document.addEventListener('keydown', (event) => {
  const isTyped = event.target.matches('select, textarea, input:not([type=range], [type=radio])');
  if (event.ctrlKey || event.altKey || event.metaKey || isTyped) return;
  kActions[event.key.toLowerCase()]?.();
});
