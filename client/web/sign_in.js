// SPDX-License-Identifier: Apache-2.0
// Signs in to a server that asks for an access token. The server keeps the token in a cookie, which
// no script can read, until the browser ends or somebody signs out.

const kSession = 'api/session';  // relative, since a proxy may serve the page below a path
const kAnswer_ms = 5000;
const kUnauthorized = 401;

const byId = (id) => document.getElementById(id);

// The token of a link such as http://HOST/#token=TOKEN, once. What follows '#' never leaves the
// browser, and here it leaves the history, too.
function takeTokenOfAddress() {
  const token = new URLSearchParams(location.hash.slice(1)).get('token');
  if (token !== null) history.replaceState(null, '', location.pathname + location.search);
  return token;
}

async function askSession(options = {}) {
  const signal = AbortSignal.timeout(kAnswer_ms);
  const reply = await fetch(kSession, {cache: 'no-store', signal, ...options});
  return {status: reply.status, answer: await reply.json()};
}

function show(answer) {
  byId('token').value = '';
  byId('sign-in-problem').textContent = '';
  byId('sign-in').hidden = true;
  byId('sign-out').hidden = !answer.id;
  if (answer.id) byId('sign-out').title = `Signed in as ${answer.id}`;
}

function offer(token) {
  // A header takes no other characters.
  const shown = /^[!-~]*$/.test(token) ? token : '';
  return askSession({method: 'POST', headers: {authorization: `Bearer ${shown}`}});
}

let entering = null;  // while somebody is asked for a token
let admit = null;     // ends that

async function tryToken(token) {
  try {
    const {status, answer} = await offer(token.trim());
    if (status !== 200) {
      byId('sign-in-problem').textContent = answer.error?.message ?? `Status ${status}.`;
      return;
    }
    show(answer);
    admit?.();
    entering = null;
  } catch {
    byId('sign-in-problem').textContent = 'The server does not answer. Try again.';
  }
}

// Resolves once the server lets this page in. Throws if it does not answer.
export async function enter() {
  const token = takeTokenOfAddress();
  if (token) await offer(token);
  const {status, answer} = await askSession();
  if (status !== kUnauthorized) {
    show(answer);
    return;
  }
  entering ??= new Promise((resolve) => { admit = resolve; });
  byId('sign-in').hidden = false;
  byId('token').focus();
  await entering;
}

byId('sign-in-form').addEventListener('submit', (event) => {
  event.preventDefault();
  tryToken(byId('token').value);
});
byId('sign-out').addEventListener('click', async () => {
  await askSession({method: 'DELETE'});
  location.reload();
});
