// SPDX-License-Identifier: Apache-2.0
// Copies the text of a field.

export async function copy(field, button) {
  field.select();
  let isCopied = false;
  try {
    await navigator.clipboard.writeText(field.value);
    isCopied = true;
  } catch {  // pages by plain http from elsewhere have no clipboard, only what is selected
    isCopied = document.execCommand('copy');
  }
  button.textContent = isCopied ? 'Copied' : 'Selected';
  setTimeout(() => { button.textContent = 'Copy'; }, 1500);
}
