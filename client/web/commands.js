// SPDX-License-Identifier: Apache-2.0
// Commands and addresses to watch the same stream elsewhere.
import {askedPath, isOnLoopback, nameOf, picturePath} from './address.js';
import {copy} from './copy.js';
import {Share} from './share.js';

const kGrpcPort = 50051;  // viewloomd's own; the page cannot know another

const byId = (id) => document.getElementById(id);

// For a POSIX shell.
function quoted(text) {
  return /^[\w.:/=+,-]+$/.test(text) ? text : `'${text.replaceAll('\'', '\'\\\'\'')}'`;
}

// asked: {stream, display, encoding}
function watchCommand({stream, display, encoding}) {
  const words = ['viewloom'];
  if (!isOnLoopback()) {
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
function stillCommand(asked) {
  const url = new URL(picturePath('still', '.jpg', asked), location.href);
  return `curl -L -O -J ${quoted(url.href)}`;
}

function socketAddress(asked) {
  const url = new URL(askedPath(asked), location.href);
  url.protocol = url.protocol.replace('http', 'ws');
  return url.href;
}

export class Commands {
  #share = new Share();

  constructor() {
    for (const name of ['watch', 'still', 'socket']) {
      const [field, button] = [byId(`command-${name}`), byId(`copy-${name}`)];
      button.addEventListener('click', () => copy(field, button));
      field.addEventListener('focus', () => field.select());
    }
  }

  // asked: {stream, display, encoding}, the latter messages as JSON
  show(asked) {
    this.#share.show(asked);
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
