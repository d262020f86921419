// Pictures as the wire carries them.
import { readFileSync } from 'node:fs';
import jpeg from 'jpeg-js';
import { PNG } from 'pngjs';

const schema = JSON.parse(readFileSync(new URL('../../protocol/schema_frame.json', import.meta.url), 'utf8'));
const kMagic = schema.frameHeader.find((field) => field.name === 'magic').value;
const kPhases = { coarse: 0, converging: 1, converged: 2 };

export function encodePicture(pixels, width, height, lossless, quality) {
  if (!lossless) return jpeg.encode({ data: pixels, width, height }, quality).data;
  const png = new PNG({ width, height, colorType: 2 });
  pixels.copy(png.data);
  return PNG.sync.write(png, { colorType: 2, deflateLevel: 1 });
}

/** The header of 116 bytes, then the payload. Field offsets: protocol/spec.md, section 5. */
export function encodeFrame(crc32c, facts, payload) {
  const header = Buffer.alloc(116);
  const u8 = {
    4: 1,
    5: 0,
    6: facts.lossless ? 1 : 0,
    7: facts.flags,
    8: kPhases[facts.phase],
    9: facts.quality,
    10: 2,
  };
  const u16 = {
    32: facts.width,
    34: facts.height,
    36: facts.width,
    38: facts.height,
    40: facts.width,
    42: facts.height,
  };
  const u32 = {
    0: kMagic,
    12: facts.frameId,
    16: facts.ackSeq,
    20: facts.sceneRevision,
    24: facts.viewRevision,
    44: facts.steps,
    48: facts.replaced,
    108: payload.length,
    112: crc32c(payload),
  };
  const f32 = {
    52: 1,
    56: facts.steps,
    60: facts.error,
    64: facts.error * 0.8,
    68: facts.error * 1.25,
    72: facts.msSinceEdit,
    76: 12,
    80: 3,
    84: 9,
    88: 2.5,
  };
  for (const [at, value] of Object.entries(u8)) header.writeUInt8(value, Number(at));
  for (const [at, value] of Object.entries(u16)) header.writeUInt16LE(value, Number(at));
  for (const [at, value] of Object.entries(u32)) header.writeUInt32LE(value, Number(at));
  for (const [at, value] of Object.entries(f32)) header.writeFloatLE(value, Number(at));
  return Buffer.concat([header, payload]);
}
