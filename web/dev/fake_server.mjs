// A stand-in for limnd, for work on the page and for its tests: serves dist/ and speaks the protocol over a toy.
//   node dev/fake_server.mjs [--listen 127.0.0.1:8080] [--size 320x240]
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { WebSocketServer } from 'ws';
import { announcement } from './fake_announcement.mjs';
import { encodeFrame, encodePicture } from './fake_frames.mjs';
import { cast, makeScene, paint, rayThrough } from './fake_scene.mjs';
import { crc32c, decodeClient, encodeServer } from './protocol.mjs';

const kTickMs = 40;
const kMime = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml' };
const kCosts = {
  material: 're-gather',
  light: 'relight',
  node: 'rebuild',
  environment: 'relight',
  camera: 're-gather',
  technique: 're-gather',
  resolve: 'display-only',
  image: 're-gather',
};

const lastStep = (scene) => scene.parameters.maxSamples ?? 64;

/** Starts a server on `port` (0: any); resolves to { port, world, close }. With `refuse` no socket opens. */
export async function startFakeServer({ port = 0, size = [320, 240], refuse = false } = {}) {
  const dist = fileURLToPath(new URL('../dist/', import.meta.url));
  const http = createServer((request, reply) => serveFile(dist, request, reply));
  const world = {
    scene: makeScene(...size),
    steps: 0,
    editedMs: Date.now(),
    restarts: 0,
    edits: 0,
    clients: new Set(),
  };
  const sockets = new WebSocketServer({
    server: http,
    path: '/ws',
    verifyClient: () => !refuse,
    handleProtocols: (offered) => (offered.has('limn.v1') ? 'limn.v1' : false),
  });
  sockets.on('connection', (socket) => new Client(world, socket));
  const timer = setInterval(() => tick(world), kTickMs);
  await new Promise((resolve) => http.listen(port, '127.0.0.1', resolve));
  return {
    port: http.address().port,
    world,
    close: () => {
      clearInterval(timer);
      for (const socket of sockets.clients) socket.terminate();
      return new Promise((resolve) => http.close(resolve));
    },
  };
}

function serveFile(dist, request, reply) {
  const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname));
  const file = join(dist, path === '/' ? 'index.html' : path);
  if (path === '/readyz') {
    reply.end('ready\n');
  } else if (!file.startsWith(dist) || !existsSync(file) || !statSync(file).isFile()) {
    reply.writeHead(404).end('nothing is here\n');
  } else {
    reply.writeHead(200, {
      'content-type': kMime[extname(file)] ?? 'application/octet-stream',
      'content-security-policy':
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self' ws:; " +
        "worker-src 'self'; base-uri 'none'",
    });
    createReadStream(file).pipe(reply);
  }
}

function tick(world) {
  if (world.steps < lastStep(world.scene))
    world.steps = Math.min(lastStep(world.scene), Math.ceil(world.steps * 1.5) + (world.steps === 0 ? 1 : 0));
  for (const client of world.clients) client.sendFrame();
}

class Client {
  constructor(world, socket) {
    Object.assign(this, {
      world,
      socket,
      seq: 0,
      greeted: false,
      inFlight: new Set(),
      frameId: 0,
      ackSeq: 0,
      replaced: 0,
      finalSent: '',
    });
    socket.on('message', (data, isBinary) => this.receive(data, isBinary));
    socket.on('close', () => world.clients.delete(this));
  }

  say(message) {
    this.socket.send(encodeServer(message));
  }

  receive(data, isBinary) {
    if (isBinary) return this.socket.close(1003);
    let message;
    try {
      message = decodeClient(data.toString());
      if (message.seq <= this.seq) throw Object.assign(new Error('seq must rise'), { code: 'bad-seq', place: '' });
    } catch (error) {
      return this.say({ op: 'error', code: error.code ?? 'bad-message', message: error.message, place: error.place });
    }
    this.seq = message.seq;
    if (message.op === 'hello') return this.greet(message);
    this.answer(message);
  }

  greet(hello) {
    this.greeted = true;
    this.world.clients.add(this);
    this.say(announcement(hello.seq));
    this.say({ op: 'scene', cause: 'joined', ...this.world.scene });
    this.sayStatus();
  }

  answer(message) {
    const { scene } = this.world;
    switch (message.op) {
      case 'ping':
        return this.say({ op: 'pong', seq: message.seq, serverSeconds: performance.now() / 1000 });
      case 'describe':
        return this.say({ op: 'scene', seq: message.seq, cause: 'asked', ...scene });
      case 'ackFrame':
        return void this.inFlight.delete(message.frameId);
      case 'camera': {
        const { op, seq, ...view } = message;
        return this.edit(seq, [{ target: 'camera', view }]);
      }
      case 'set': {
        const { op, seq, ...edit } = message;
        return this.edit(seq, [edit]);
      }
      case 'batch':
        return this.edit(message.seq, message.edits);
      case 'pick':
        return this.pick(message);
      case 'bye':
        return this.socket.close(1000);
      case 'load':
        return this.say({
          op: 'error',
          seq: message.seq,
          code: 'io',
          message: 'the toy holds one scene only',
          place: message.uri,
        });
      default:
        return this.say({
          op: 'error',
          seq: message.seq,
          code: 'unsupported',
          message: `the toy cannot ${message.op}`,
        });
    }
  }

  pick({ seq, x, y }) {
    const { scene } = this.world;
    const hit = cast(scene, scene.view.eye, rayThrough(scene, x, y));
    if (!hit) return this.say({ op: 'picked', seq, hit: false });
    this.say({
      op: 'picked',
      seq,
      hit: true,
      node: hit.node,
      material: hit.material,
      primitive: 0,
      posW: hit.position,
      normalW: hit.normal,
      distance: hit.t,
    });
  }

  edit(seq, edits) {
    const { world } = this;
    const { scene } = world;
    // The toy's own rule, so that a refused edit can be seen: 0.777 is not liked.
    if (edits.some((e) => e.roughness === 0.777))
      return this.say({
        op: 'error',
        seq,
        code: 'out-of-range',
        message: 'the toy does not like 0.777',
        place: `seq ${seq} /roughness`,
      });
    for (const edit of edits) applyEdit(scene, edit);
    const viewOnly = edits.every((e) => ['camera', 'resolve', 'image'].includes(e.target));
    if (viewOnly) scene.viewRevision++;
    else scene.sceneRevision++;
    const cost = kCosts[edits.at(-1).target];
    world.edits++;
    if (cost !== 'display-only') Object.assign(world, { steps: 0, restarts: world.restarts + 1 });
    world.editedMs = Date.now();
    this.ackSeq = seq;
    this.say({
      op: 'ack',
      seq,
      cost,
      sceneRevision: scene.sceneRevision,
      viewRevision: scene.viewRevision,
      superseded: false,
    });
    for (const other of world.clients) if (other !== this) other.say({ op: 'scene', cause: 'edited', ...scene });
  }

  sendFrame() {
    const { scene, steps, editedMs } = this.world;
    const final = steps === lastStep(scene);
    const state = `${scene.sceneRevision}/${scene.viewRevision}`;
    if (steps === 0 || (final && this.finalSent === state)) return;
    if (this.inFlight.size >= 2) return void this.replaced++;
    const moving = Date.now() - editedMs < 150;
    const quality = final ? 0 : moving ? 60 : 90;
    const payload = encodePicture(paint(scene, steps), scene.width, scene.height, final, quality);
    const facts = {
      lossless: final,
      flags: (moving ? 1 : 0) | (final ? 6 : 0) | 8,
      phase: final ? 'converged' : steps < 4 ? 'coarse' : 'converging',
      quality,
      frameId: ++this.frameId,
      ackSeq: this.ackSeq,
      sceneRevision: scene.sceneRevision,
      viewRevision: scene.viewRevision,
      width: scene.width,
      height: scene.height,
      steps,
      replaced: this.replaced,
      error: steps < 4 ? Infinity : 0.3 / steps,
      msSinceEdit: Date.now() - editedMs,
    };
    this.finalSent = final ? state : '';
    this.inFlight.add(this.frameId);
    this.socket.send(encodeFrame(crc32c, facts, payload));
    this.sayStatus();
  }

  sayStatus() {
    const { steps, restarts, edits, clients, editedMs, scene } = this.world;
    const idle = steps === lastStep(scene);
    this.say({
      op: 'status',
      phase: idle ? 'converged' : 'converging',
      idle,
      steps,
      meanSamples: steps,
      raysPerSecond: idle ? 0 : 3.2e6,
      secondsSinceRestart: (Date.now() - editedMs) / 1000,
      discardedSamples: 0,
      discardedShare: 0,
      editsApplied: edits,
      restarts,
      framesPublished: this.frameId,
      quanta: steps,
      pipelinesCreated: 12,
      technique: scene.technique,
      ran: ['g-buffer', 'punctual lights', 'emitters'],
      leftOut: ['textures', 'specular chains'],
      memory: { film: 4_915_200, scene: 1_204_000, bvh: 822_000 },
      stageMs: { trace: 9, resolve: 2.5 },
      figures: { points: 262_144, pointRelativeRadius: 0.71 },
      clients: clients.size,
      framesSent: this.frameId,
      framesReplaced: this.replaced,
    });
  }
}

function applyEdit(scene, edit) {
  const { target, material, light, node, view, ...fields } = edit;
  if (target === 'material') Object.assign(scene.materials[material], fields);
  else if (target === 'light') Object.assign(scene.lights[light], fields);
  else if (target === 'node') Object.assign(scene.nodes[node], fields);
  else if (target === 'environment') Object.assign(scene.environment, fields);
  else if (target === 'camera') Object.assign(scene.view, view);
  else if (target === 'resolve') Object.assign(scene.resolve, fields);
  else if (target === 'image') Object.assign(scene, fields);
  else if (target === 'technique') Object.assign(scene.parameters, fields.parameters);
  if (!fields.technique) return;
  scene.technique = fields.technique;
  scene.parameters = Object.fromEntries(
    announcement(1)
      .techniques.find((t) => t.name === fields.technique)
      .parameters.map((p) => [p.name, p.default]),
  );
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href) {
  const argument = (name) => process.argv[process.argv.indexOf(name) + 1] ?? '';
  const port = Number(/:(\d+)$/.exec(argument('--listen'))?.[1] ?? 8080);
  const size = /^(\d+)x(\d+)$/.exec(argument('--size'))?.slice(1).map(Number) ?? [320, 240];
  await startFakeServer({ port, size });
  console.log(`listening on http://127.0.0.1:${port}/`);
}
