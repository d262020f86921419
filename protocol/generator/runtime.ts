interface Field {
  name: string;
  type: string;
  optional?: boolean;
  inline?: boolean;
  min?: number;
  max?: number;
  minItems?: number;
  maxItems?: number;
  maxLength?: number;
}

/** What is wrong with a message, and where (a JSON pointer, or a byte of a frame). */
export class ProtocolError extends Error {
  constructor(readonly code: string, message: string, readonly place: string) {
    super(place === "" ? message : `${place}: ${message}`);
    this.name = "ProtocolError";
  }
}

type Plain = { [key: string]: unknown };
const kIntegers: { [type: string]: [number, number] } = {
  u8: [0, 255], u16: [0, 65535], u32: [0, 4294967295], i32: [-2147483648, 2147483647], u53: [0, Number.MAX_SAFE_INTEGER],
};

function isPlain(value: unknown): value is Plain {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** The table's own entry; never one that every object inherits. */
function entry<T>(table: { [name: string]: T }, name: unknown): T | undefined {
  return typeof name === "string" && Object.hasOwn(table, name) ? table[name] : undefined;
}

function wrong(expected: string, place: string): never {
  throw new ProtocolError("bad-message", `expected ${expected}`, place);
}

function readNumber(value: unknown, base: string, field: Field, place: string): number {
  if (typeof value !== "number" || !Number.isFinite(value)) wrong("a number", place);
  const whole = kIntegers[base];
  const low = field.min ?? whole?.[0] ?? -Infinity;
  const high = field.max ?? whole?.[1] ?? Infinity;
  if (value < low || value > high) throw new ProtocolError("out-of-range", `${value} is outside ${low} to ${high}`, place);
  if (whole && !Number.isInteger(value)) wrong("a whole number", place);
  return value === 0 ? 0 : value;  // -0 is written as 0
}

/** One value of a scalar, enum, struct or union type, with its fields in the schema's order. */
function readOne(value: unknown, base: string, field: Field, place: string, strict: boolean): unknown {
  if (base === "bool") return typeof value === "boolean" ? value : wrong("a boolean", place);
  if (base === "string" || base === "hash") {
    if (typeof value !== "string") wrong("a string", place);
    if (base === "hash" && !/^[0-9a-f]{16}$/.test(value)) wrong("16 lower-case hexadecimal digits", place);
    return value;
  }
  const words = kEnums[base];
  if (words) {
    if (typeof value === "string" && words.includes(value)) return value;
    throw new ProtocolError("out-of-range", `expected one of ${words.join(", ")}`, place);
  }
  if (kStructs[base] ?? kUnions[base]) {
    if (!isPlain(value)) wrong("an object", place);
    const left = new Set(Object.keys(value));
    const out = readFields(value, base, place, strict, left);
    if (strict) for (const name of left) throw new ProtocolError("bad-message", "unknown field", `${place}/${name}`);
    return out;
  }
  return readNumber(value, base, field, place);
}

function readFields(value: Plain, type: string, place: string, strict: boolean, left: Set<string>): Plain {
  const out: Plain = {};
  let fields = kStructs[type];
  const union = kUnions[type];
  if (union) {
    const word = value[union.tag];
    const member = entry(union.members, word);
    if (member === undefined) throw new ProtocolError("out-of-range", "no such alternative", `${place}/${union.tag}`);
    left.delete(union.tag);
    out[union.tag] = word;
    fields = kStructs[member];
  }
  for (const field of fields ?? []) {
    if (field.inline) {
      Object.assign(out, readFields(value, field.type, place, strict, left));
      continue;
    }
    left.delete(field.name);
    const item = value[field.name];
    if (item !== undefined) out[field.name] = readShaped(item, field, `${place}/${field.name}`, strict);
    else if (!field.optional) throw new ProtocolError("bad-message", `field ${field.name} is missing`, `${place}/${field.name}`);
  }
  return out;
}

function readShaped(value: unknown, field: Field, place: string, strict: boolean): unknown {
  const match = /^(\w+)(\[\]|\{\}|\[(\d+)\])?$/.exec(field.type);
  const base = match?.[1] ?? "";
  const shape = match?.[2];
  if (shape === undefined) return readOne(value, base, field, place, strict);
  if (shape === "{}") {
    if (!isPlain(value)) wrong("an object", place);
    const read = ([name, item]: [string, unknown]) => [name, readOne(item, base, field, `${place}/${name}`, strict)];
    return Object.fromEntries(Object.entries(value).map(read));
  }
  if (!Array.isArray(value)) wrong("an array", place);
  const count = match?.[3];
  if (count !== undefined && value.length !== Number(count)) wrong(`${count} items`, place);
  const outside = value.length < (field.minItems ?? 0) || value.length > (field.maxItems ?? Infinity);
  if (outside) throw new ProtocolError("out-of-range", `${value.length} items`, place);
  return value.map((item, i) => readOne(item, base, field, `${place}/${i}`, strict));
}

function readMessage(json: string, ops: { [op: string]: string }, strict: boolean): Plain {
  let value: unknown;
  try {
    value = JSON.parse(json);
  } catch {
    throw new ProtocolError("bad-message", "malformed JSON", "");
  }
  if (!isPlain(value)) wrong("an object", "");
  const type = entry(ops, value.op);
  if (type === undefined) throw new ProtocolError("unknown-op", "no such op", "/op");
  const left = new Set(Object.keys(value));
  left.delete("op");
  const out = { op: value.op, ...readFields(value, type, "", strict, left) };
  if (strict) for (const name of left) throw new ProtocolError("bad-message", "unknown field", `/${name}`);
  return out;
}

/** The message as JSON, fields in the schema's order. Throws ProtocolError where it is not what the schema says. */
export function encodeClient(message: ClientMessage): string {
  return JSON.stringify(readMessage(JSON.stringify(message), kClientOps, true));
}

export function encodeServer(message: ServerMessage): string {
  return JSON.stringify(readMessage(JSON.stringify(message), kServerOps, true));
}

/** Reads a text message of a client, strictly. Throws ProtocolError. */
export function decodeClient(json: string): ClientMessage {
  return readMessage(json, kClientOps, true) as unknown as ClientMessage;
}

/** Reads a text message of a server. Fields that this version does not know are passed over unless `strict`. Throws ProtocolError. */
export function decodeServer(json: string, strict = false): ServerMessage {
  return readMessage(json, kServerOps, strict) as unknown as ServerMessage;
}

const kCrcTable = Uint32Array.from({ length: 256 }, (_, b) => {
  let crc = b;
  for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0x82f63b78 : 0);
  return crc;
});

/** CRC-32C (Castagnoli) of `bytes`. */
export function crc32c(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (let i = 0; i < bytes.length; ++i) crc = (crc >>> 8) ^ (kCrcTable[(crc ^ (bytes[i] as number)) & 0xff] as number);
  return (crc ^ 0xffffffff) >>> 0;
}

/** Takes a binary message apart; `payload` is a view into it. Throws ProtocolError (header, length, CRC). */
export function decodeFrame(message: ArrayBuffer): { header: FrameHeader; payload: Uint8Array } {
  const header = decodeFrameHeader(new DataView(message));
  const payload = new Uint8Array(message, kFrameHeaderBytes);
  if (payload.length !== header.payloadBytes) throw new ProtocolError("bad-message", "the payload's length is wrong", "byte 0");
  if (crc32c(payload) !== header.crc32c) throw new ProtocolError("bad-message", "the payload's CRC is wrong", "byte 0");
  return { header, payload };
}

/** The binary message of a header and its payload, whose length and CRC are taken from `payload`. Throws ProtocolError. */
export function encodeFrame(header: FrameHeader, payload: Uint8Array): ArrayBuffer {
  const message = new ArrayBuffer(kFrameHeaderBytes + payload.length);
  encodeFrameHeader({ ...header, payloadBytes: payload.length, crc32c: crc32c(payload) }, new DataView(message));
  new Uint8Array(message, kFrameHeaderBytes).set(payload);
  return message;
}
