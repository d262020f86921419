// The generated protocol for plain Node programs, which cannot load TypeScript by themselves.
import { readFileSync } from 'node:fs';
import { transformWithEsbuild } from 'vite';

const file = new URL('../src/protocol/messages.gen.ts', import.meta.url);
const { code } = await transformWithEsbuild(readFileSync(file, 'utf8'), 'messages.gen.ts', {
  format: 'esm',
  sourcemap: false,
});
const protocol = await import('data:text/javascript;base64,' + Buffer.from(code).toString('base64'));

export const { decodeClient, decodeServer, encodeClient, encodeServer, decodeFrame, crc32c, ProtocolError } = protocol;
