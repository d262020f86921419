// Binary glTF files as they are changed between two daemons.
const kHeaderBytes = 12;
const kChunkHeaderBytes = 8;

/** The bytes of a .glb whose node `node` has another translation. */
export function withTranslation(glb, node, translation) {
  const jsonBytes = glb.readUInt32LE(kHeaderBytes);
  const jsonBegin = kHeaderBytes + kChunkHeaderBytes;
  const document = JSON.parse(glb.toString('utf8', jsonBegin, jsonBegin + jsonBytes));
  document.nodes[node].translation = translation;
  const text = Buffer.from(JSON.stringify(document));
  const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
  const header = Buffer.from(glb.subarray(0, jsonBegin));
  header.writeUInt32LE(glb.length - jsonBytes + json.length, 8);
  header.writeUInt32LE(json.length, kHeaderBytes);
  return Buffer.concat([header, json, glb.subarray(jsonBegin + jsonBytes)]);
}
