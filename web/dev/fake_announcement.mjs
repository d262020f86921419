// What the toy server says in its hello. Editable fields are those of the schema.
import { readFileSync } from 'node:fs';

const schema = JSON.parse(readFileSync(new URL('../../protocol/schema.json', import.meta.url), 'utf8'));
const enums = Object.fromEntries(schema.enums.map((e) => [e.name, e.values.map(([word]) => word)]));

function editableField(field) {
  const choices = enums[field.type];
  return {
    name: field.name,
    kind:
      field.kind ??
      (choices ? 'choice' : field.type === 'string' ? 'text' : field.type.endsWith('{}') ? 'parameters' : 'number'),
    unit: field.unit ?? '1',
    description: field.doc,
    ...(field.min === undefined ? {} : { minimum: field.min }),
    ...(field.max === undefined ? {} : { maximum: field.max }),
    ...(field.soft ? { softMinimum: field.soft[0], softMaximum: field.soft[1] } : {}),
    ...(choices ? { choices } : {}),
  };
}

function editableTargets() {
  const union = schema.unions.find((u) => u.name === 'Edit');
  return union.members
    .filter(([target]) => target !== 'camera')
    .map(([target, struct]) => ({
      target,
      fields: schema.structs
        .find((s) => s.name === struct)
        .fields.filter((f) => f.name !== target || target === 'technique')
        .map(editableField),
    }));
}

const parameter = (name, description, unit, type, minimum, maximum, value, cost = 're-gather') => ({
  name,
  description,
  unit,
  type,
  minimum,
  maximum,
  default: value,
  cost,
});

export const announcement = (seq) => ({
  op: 'hello',
  seq,
  version: 1,
  server: 'fake 0.1',
  device: 'toy renderer (JavaScript)',
  clientId: 1,
  limits: {
    maxControlBytes: 1048576,
    maxFragmentBytes: 65536,
    framesInFlight: 2,
    maxEditsPerBatch: 1024,
    maxImageSide: 2048,
    maxClients: 16,
    messagesPerSecond: 400,
  },
  techniques: [
    {
      name: 'path-tracing',
      title: 'Path tracing',
      description: 'Random walks from the eye with next-event estimation.',
      biased: false,
      parameters: [
        parameter('maxBounces', 'Longest path.', 'bounces', 'integer', 1, 64, 8),
        parameter('clampIndirect', 'Largest indirect sample, 0 for none.', 'W·sr⁻¹·m⁻²', 'real', 0, 100, 0),
        parameter('maxSamples', 'Samples at which every pixel stops.', 'samples', 'integer', 1, 1048576, 1024),
        parameter('russianRoulette', 'Ends dim paths early.', '1', 'boolean', 0, 1, 1),
      ],
    },
    {
      name: 'flat',
      title: 'Flat',
      description: 'No light goes anywhere.',
      biased: true,
      parameters: [parameter('gain', 'A factor.', '1', 'real', 0, 4, 1, 'relight')],
    },
  ],
  toneMaps: ['pbr-neutral', 'aces', 'agx', 'linear'],
  encodings: ['jpeg', 'png'],
  layers: ['beauty', 'error'],
  stages: ['trace', 'resolve'],
  editable: editableTargets(),
});
