// A client that shares nothing with the page but the wire: reads the protocol by the offsets of protocol/spec.md.
import { createHash } from 'node:crypto';
import { requireFromWeb } from './browser.mjs';

const WebSocket = requireFromWeb('ws');
const { PNG } = requireFromWeb('pngjs');

const kHeaderBytes = 116;
const kLossless = 2;
const kFinal = 4;
const kPng = 1;

export class Peer {
  static async connect(port) {
    const socket = new WebSocket(`ws://127.0.0.1:${port}/ws`, 'limn.v1');
    const peer = new Peer(socket);
    await new Promise((resolve, reject) => socket.once('open', resolve).once('error', reject));
    peer.send({ op: 'hello', version: 1, client: 'web test peer' });
    return peer;
  }

  constructor(socket) {
    Object.assign(this, { socket, seq: 0, heard: [], waiting: [] });
    socket.on('message', (data, isBinary) => this.receive(isBinary ? readFrame(data) : JSON.parse(data.toString())));
    socket.on('close', (code) => this.receive({ op: 'closed', code }));
  }

  send(message) {
    const { op, ...fields } = message;
    this.socket.send(JSON.stringify({ op, seq: ++this.seq, ...fields }));
    return this.seq;
  }

  receive(message) {
    if (message.op === 'frame') this.send({ op: 'ackFrame', frameId: message.frameId, dropped: false });
    this.heard.push(message);
    this.waiting = this.waiting.filter(({ matches, resolve }) => !(matches(message) && (resolve(message), true)));
  }

  /** The newest message so far, or the next, that matches. */
  next(matches) {
    const heard = this.heard.findLast?.(matches) ?? [...this.heard].reverse().find(matches);
    return heard ? Promise.resolve(heard) : new Promise((resolve) => this.waiting.push({ matches, resolve }));
  }

  /** The lossless picture at rest, as SHA-256 over RGBA bytes. */
  async finalPicture() {
    const frame = await this.next((m) => m.op === 'frame' && m.isFinal);
    const png = PNG.sync.read(frame.payload);
    return {
      width: png.width,
      height: png.height,
      sceneRevision: frame.sceneRevision,
      viewRevision: frame.viewRevision,
      sha256: createHash('sha256').update(png.data).digest('hex'),
    };
  }

  /** The scene as the server describes it now. */
  describe() {
    const seq = this.send({ op: 'describe' });
    return this.next((m) => m.op === 'scene' && m.seq === seq);
  }

  close() {
    this.socket.terminate();
  }
}

function readFrame(data) {
  const flags = data.readUInt8(7);
  return {
    op: 'frame',
    frameId: data.readUInt32LE(12),
    sceneRevision: data.readUInt32LE(20),
    viewRevision: data.readUInt32LE(24),
    isFinal: data.readUInt8(6) === kPng && (flags & (kLossless | kFinal)) === (kLossless | kFinal),
    payload: data.subarray(kHeaderBytes),
  };
}
