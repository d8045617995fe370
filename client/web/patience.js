// SPDX-License-Identifier: Apache-2.0
// Says so when a picture that was asked for is long in coming.
import {notice, takeBack} from './notice.js';

const kLong_ms = 2500;
const kText = 'Still waiting for the picture: what is asked for takes the server long, ' +
    'or the stream has no frame yet.';

export class Patience {
  #timer = 0;

  // Something else is asked for.
  begin() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => notice(kText, '', Infinity), kLong_ms);
  }

  // A picture came, or there is nobody to give one.
  end() {
    clearTimeout(this.#timer);
    takeBack(kText);
  }
}
