// SPDX-License-Identifier: Apache-2.0
// Commands and addresses to watch the same stream elsewhere.
import {askedPath, nameOf} from './address.js';

const kGrpcPort = 50051;  // viewloomd's own; the page cannot know another
const kLoopback = ['localhost', '127.0.0.1', '[::1]'];

const byId = (id) => document.getElementById(id);

// For a POSIX shell.
function quoted(text) {
  return /^[\w.:/=+,-]+$/.test(text) ? text : `'${text.replaceAll('\'', '\'\\\'\'')}'`;
}

// asked: {stream, display, encoding}
function watchCommand({stream, display, encoding}) {
  const words = ['viewloom'];
  if (!kLoopback.includes(location.hostname)) {
    words.push('--server', `${location.hostname}:${kGrpcPort}`);
  }
  words.push('watch', stream);
  const name = nameOf(display);
  if (name) words.push('--preset', name);
  else words.push('--display', JSON.stringify(display));
  if (Object.keys(encoding).length > 0) words.push('--encoding', JSON.stringify(encoding));
  return [...words, '--out', 'atlases'].map(quoted).join(' ');
}

// The server tells curl the file's name.
function stillCommand({stream, display, encoding}) {
  const name = nameOf(display);
  const path = name ? `/${encodeURIComponent(name)}` : '.jpg';
  const url = new URL(`still/${encodeURIComponent(stream)}${path}`, location.href);
  if (!name) url.searchParams.set('display', JSON.stringify(display));
  if (Object.keys(encoding).length > 0) {
    url.searchParams.set('encoding', JSON.stringify(encoding));
  }
  return `curl -L -O -J ${quoted(url.href)}`;
}

function socketAddress(asked) {
  const url = new URL(askedPath(asked), location.href);
  url.protocol = url.protocol.replace('http', 'ws');
  return url.href;
}

async function copy(field, button) {
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

export class Commands {
  constructor() {
    for (const name of ['watch', 'still', 'socket']) {
      const [field, button] = [byId(`command-${name}`), byId(`copy-${name}`)];
      button.addEventListener('click', () => copy(field, button));
      field.addEventListener('focus', () => field.select());
    }
  }

  // asked: {stream, display, encoding}, the latter messages as JSON
  show(asked) {
    const texts = {
      watch: watchCommand(asked),
      still: stillCommand(asked),
      socket: socketAddress(asked),
    };
    for (const [name, text] of Object.entries(texts)) {
      if (byId(`command-${name}`).value !== text) byId(`command-${name}`).value = text;
    }
  }
}
