// Shared by the clients in JavaScript: counted checks, and the summary.
'use strict';
const { isDeepStrictEqual, inspect } = require('node:util');

const port = Number(process.env.S7_PORT);
let done = 0;
let failed = 0;

/** It is true. */
function holds(what, isTrue, why = '') {
  done += 1;
  if (!isTrue) {
    failed += 1;
    console.log(`FAILED ${what}: ${why}`);
  }
}

/** Both are the same. */
function equal(what, found, expected) {
  holds(what, isDeepStrictEqual(found, expected), `expected ${inspect(expected)}, found ${inspect(found)}`);
}

/** It is refused. */
async function fails(what, action) {
  try {
    const found = await action();
    holds(what, false, `an error was due, found ${inspect(found)}`);
  } catch {
    holds(what, true);
  }
}

const sleep = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** It is so within three seconds. */
async function becomes(what, read, expected) {
  const end = Date.now() + 3000;
  let found = await read();
  while (!isDeepStrictEqual(found, expected) && Date.now() < end) {
    await sleep(20);
    found = await read();
  }
  equal(what, found, expected);
}

/** Runs the script of a client, and prints its last line. */
function run(script) {
  const end = () => {
    console.log(`checks ${done} failed ${failed}`);
    process.exit(failed ? 1 : 0);
  };
  script().then(end, (error) => {
    holds('it runs to its end', false, error.stack);
    end();
  });
}

const pattern = [0x8c, 0x00, 0xff];

module.exports = { becomes, equal, fails, holds, pattern, port, run, sleep };
