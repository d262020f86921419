/// <reference lib="webworker" />
/** The stream: owns the socket, decodes frames, draws them on the picture's canvas and gives their credits back. */
import type { FrameReport, Outgoing, ToPage, ToWorker } from '../channel';
import { nowMs } from '../clock';
import { decodeFrame, kFrameHeaderBytes, kVersion, type FrameHeader } from '../protocol/messages.gen';
import { Connection } from './connection';
import { DecodeQueue, type EncodedFrame } from './decode_queue';
import { Presenter } from './presenter';

const scope = self as unknown as DedicatedWorkerGlobalScope;
// A page that nobody has looked at for so long lets go of the server, which then may rest.
const kHiddenMs = 60_000;

let connection: Connection | null = null;
let presenter: Presenter | null = null;
let hiddenTimer: ReturnType<typeof setTimeout> | undefined;

const tell = (message: ToPage, transfer: Transferable[] = []) => scope.postMessage(message, transfer);
const fault = (text: string) => tell({ type: 'fault', text });

function start(canvas: OffscreenCanvas, url: string, token: string | null, client: string): void {
  const screen = new Presenter(canvas);
  const decodeMs = new WeakMap<EncodedFrame, number>();
  const queue = new DecodeQueue<ImageBitmap>({
    decode: async (frame) => {
      const before = nowMs();
      const picture = await Presenter.decode(frame);
      decodeMs.set(frame, nowMs() - before);
      return picture;
    },
    present: (frame, picture) => screen.present(frame, picture),
    discard: (picture) => picture.close(),
    acknowledge: (frame, dropped) => {
      const presentedMs = nowMs();
      const { frameId } = frame.header;
      link.send({ op: 'ackFrame', frameId, decodeMs: presentedMs - frame.receivedMs, dropped });
      const report: FrameReport = {
        header: frame.header,
        dropped,
        presentedMs,
        receivedMs: frame.receivedMs,
        decodeMs: decodeMs.get(frame) ?? 0,
        bytes: frame.payload.byteLength + kFrameHeaderBytes,
      };
      tell({ type: 'frame', frame: report });
    },
    failed: (frame, reason) => fault(`frame ${frame.header.frameId} could not be shown: ${String(reason)}`),
  });
  const link = new Connection(url, token, {
    onState: (state) => tell({ type: 'state', state }),
    onOpen: () => queue.reset(),
    onMessage: (message) => tell({ type: 'message', message }),
    onBinary: (data) => receiveBinary(data, queue),
    onFault: fault,
    hello: () => ({ op: 'hello', version: kVersion, client, encodings: ['jpeg', 'png'] }),
  });
  presenter = screen;
  connection = link;
  link.open();
}

/** Takes a binary message apart. What is malformed is told and not acknowledged: there is no frame id to trust. */
function receiveBinary(data: ArrayBuffer, queue: DecodeQueue<ImageBitmap>): FrameHeader | null {
  const receivedMs = nowMs();
  try {
    const { header, payload } = decodeFrame(data);
    if (header.kind === 'file') tell({ type: 'file', header, bytes: payload }, [data]);
    else queue.push({ header, payload, receivedMs });
    return header;
  } catch (reason) {
    fault(`the server sent a broken frame: ${String(reason)}`);
    return null;
  }
}

function send(ticket: number, message: Outgoing): void {
  try {
    const seq = connection?.send(message) ?? null;
    tell({ type: 'sent', ticket, seq, ...(seq === null ? { reason: 'there is no connection' } : {}) });
  } catch (reason) {
    tell({ type: 'sent', ticket, seq: null, reason: String(reason) });
  }
}

async function sendPng(ticket: number): Promise<void> {
  let png: Blob | null = null;
  try {
    png = (await presenter?.png()) ?? null;
  } catch (reason) {
    fault(`the picture could not be written as PNG: ${String(reason)}`);
  }
  tell({ type: 'png', ticket, png });
}

function setHidden(hidden: boolean): void {
  presenter?.setHidden(hidden);
  clearTimeout(hiddenTimer);
  if (hidden) hiddenTimer = setTimeout(() => connection?.pause(), kHiddenMs);
  else connection?.hurry();
}

scope.onmessage = async ({ data }: MessageEvent<ToWorker>) => {
  switch (data.type) {
    case 'start':
      start(data.canvas, data.url, data.token, data.client);
      break;
    case 'send':
      send(data.ticket, data.message);
      break;
    case 'retry':
      connection?.hurry();
      break;
    case 'hidden':
      setHidden(data.hidden);
      break;
    case 'png':
      await sendPng(data.ticket);
      break;
    case 'hash':
      if (presenter) tell({ type: 'hash', ticket: data.ticket, hash: await presenter.hash() });
      break;
    case 'mean':
      if (presenter) tell({ type: 'mean', ticket: data.ticket, rgb: presenter.mean(data.area) });
      break;
  }
};
