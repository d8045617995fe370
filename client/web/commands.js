// SPDX-License-Identifier: Apache-2.0
// What is watched here, as commands and addresses to watch it elsewhere.

const kGrpcPort = 50051;  // viewloomd's own; the page cannot know another
const kLoopback = ['localhost', '127.0.0.1', '[::1]'];
// Parameters of /ws, and the options of `viewloom watch` that mean the same.
const kOptions = {
  preset: '--preset', columns: '--columns', rows: '--rows', cone_deg: '--cone',
  focus_m: '--focal-distance', fov_deg: '--fov', quality: '--quality',
};

const byId = (id) => document.getElementById(id);

// For a POSIX shell.
function quoted(text) {
  return /^[\w.:/=+,-]+$/.test(text) ? text : `'${text.replaceAll('\'', '\'\\\'\'')}'`;
}

// parameters: URLSearchParams of /ws. Views have the aspect of their tiles there.
function watchCommand(parameters) {
  const words = ['viewloom'];
  if (!kLoopback.includes(location.hostname)) {
    words.push('--server', `${location.hostname}:${kGrpcPort}`);
  }
  words.push('watch', '--stream', parameters.get('stream'));
  for (const [name, option] of Object.entries(kOptions)) {
    if (parameters.has(name)) words.push(option, parameters.get(name));
  }
  if (parameters.has('width') && parameters.has('height')) {
    words.push('--size', `${parameters.get('width')}x${parameters.get('height')}`);
  }
  if (parameters.get('chroma') === '444') words.push('--444');
  return [...words, '--out', 'atlases'].map(quoted).join(' ');
}

function stillCommand(parameters, suffix) {
  const query = new URLSearchParams(parameters);
  query.delete('stream');
  const file = `${encodeURIComponent(parameters.get('stream'))}${suffix}.jpg`;
  const url = new URL(`/still/${file}`, location.href);
  url.search = query;
  return `curl -o ${quoted(decodeURIComponent(file))} ${quoted(url.href)}`;
}

function socketAddress(parameters) {
  const url = new URL(`/ws?${parameters}`, location.href);
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

  // parameters: URLSearchParams of /ws; layout: of an atlas that they gave
  show(parameters, layout) {
    const texts = {
      watch: watchCommand(parameters),
      still: stillCommand(parameters, layout.suffix),
      socket: socketAddress(parameters),
    };
    for (const [name, text] of Object.entries(texts)) {
      if (byId(`command-${name}`).value !== text) byId(`command-${name}`).value = text;
    }
  }
}
