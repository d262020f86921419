// limnd as a process of its own, on a port of its own.
import { spawn } from 'node:child_process';
import { createServer } from 'node:net';

const kReadyMs = 90_000;

/** A port that nobody listens on; the daemon is to be restarted on the same one, so it cannot pick. */
export async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Starts the program of the environment's LIMND, on LIMN_SCENE if no other is named, and waits until it is ready. */
export async function startDaemon(port, extra = [], scene = process.env.LIMN_SCENE) {
  const { LIMND } = process.env;
  if (!LIMND || !scene) throw new Error('set LIMND to the program and LIMN_SCENE to a scene file');
  const args = ['--scene', scene, '--listen', `127.0.0.1:${port}`, ...extra];
  // A script stands in for the program while these tests themselves are worked on.
  const command = LIMND.endsWith('.mjs') ? [process.execPath, [LIMND, ...args]] : [LIMND, args];
  const child = spawn(...command, { stdio: ['ignore', 'pipe', 'pipe'] });
  let log = '';
  for (const stream of [child.stdout, child.stderr])
    stream.on('data', (data) => {
      log = (log + data).slice(-20_000);
    });
  const ended = new Promise((resolve) => child.once('exit', (code, signal) => resolve(signal ?? code)));
  const daemon = {
    child,
    ended,
    log: () => log,
    kill: async (signal) => {
      child.kill(signal);
      return ended;
    },
  };
  await ready(daemon, port);
  return daemon;
}

async function ready(daemon, port) {
  const until = Date.now() + kReadyMs;
  let ending = null;
  daemon.ended.then((how) => {
    ending = how;
  });
  while (Date.now() < until) {
    if (ending !== null) throw new Error(`the daemon ended with ${ending}:\n${daemon.log()}`);
    const reply = await fetch(`http://127.0.0.1:${port}/readyz`).catch(() => null);
    if (reply?.ok) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  await daemon.kill('SIGKILL');
  throw new Error(`the daemon was not ready in time:\n${daemon.log()}`);
}
