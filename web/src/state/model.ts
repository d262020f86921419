import type { Edit, NodeEdit, SceneMessage, SceneNode, ServerHello, Status } from '../protocol/messages.gen';
import type { ConnectionState } from '../channel';

/** What the panels show in detail. */
export type Selection =
  | { kind: 'nothing' }
  | { kind: 'node'; node: number; material?: number }
  | { kind: 'material'; material: number }
  | { kind: 'light'; light: number }
  | { kind: 'environment' };

interface Events {
  hello: ServerHello;
  scene: SceneMessage;
  /** A value was edited here; the structure of the scene is as before. */
  edited: Edit;
  status: Status;
  selection: Selection;
  connection: ConnectionState;
}

type Listener<T> = (value: T) => void;

/** The page's copy of the server's truth, and who wants to know about it. */
export class Model {
  hello: ServerHello | null = null;
  scene: SceneMessage | null = null;
  status: Status | null = null;
  connection: ConnectionState = { kind: 'connecting' };
  selection: Selection = { kind: 'nothing' };
  /** The scene was told on the present connection. */
  private synchronised = false;
  private listeners: { [K in keyof Events]?: Listener<Events[K]>[] } = {};

  on<K extends keyof Events>(event: K, listener: Listener<Events[K]>): void {
    const list: Listener<Events[K]>[] = (this.listeners[event] as Listener<Events[K]>[] | undefined) ?? [];
    list.push(listener);
    Object.assign(this.listeners, { [event]: list });
  }

  setHello(hello: ServerHello): void {
    this.hello = hello;
    this.emit('hello', hello);
  }

  setScene(scene: SceneMessage): void {
    const other = this.scene?.name !== scene.name || scene.cause === 'loaded';
    this.scene = scene;
    this.synchronised = true;
    if (other || !selectionExists(scene, this.selection)) this.select({ kind: 'nothing' });
    this.emit('scene', scene);
  }

  setStatus(status: Status): void {
    this.status = status;
    this.emit('status', status);
  }

  setConnection(state: ConnectionState): void {
    this.connection = state;
    if (state.kind !== 'connected') this.synchronised = false;
    this.emit('connection', state);
  }

  /** True when edits can be sent: connected, and what they refer to is what the server holds. */
  connected(): boolean {
    return this.connection.kind === 'connected' && this.synchronised;
  }

  /** Lets everybody show the scene as it is known, over what was typed. Nothing was joined or loaded by that. */
  showAgain(): void {
    if (this.scene) this.emit('scene', { ...this.scene, cause: 'asked' });
  }

  select(selection: Selection): void {
    this.selection = selection;
    this.emit('selection', selection);
  }

  /** Shows an edit at once; should the server refuse it, its next scene message puts the truth back. */
  applyLocally(edit: Edit): void {
    if (!this.scene) return;
    this.scene = withEdit(this.scene, edit);
    this.emit('edited', edit);
  }

  private emit<K extends keyof Events>(event: K, value: Events[K]): void {
    (this.listeners[event] as Listener<Events[K]>[] | undefined)?.forEach((listener) => listener(value));
  }
}

function selectionExists(scene: SceneMessage, selection: Selection): boolean {
  switch (selection.kind) {
    case 'node':
      return selection.node < scene.nodes.length && (selection.material ?? 0) < Math.max(1, scene.materials.length);
    case 'material':
      return selection.material < scene.materials.length;
    case 'light':
      return selection.light < scene.lights.length;
    default:
      return true;
  }
}

const replaceAt = <T>(list: readonly T[], index: number, change: Partial<T>): T[] =>
  list.map((item, i) => (i === index ? { ...item, ...change } : item));

/** A node placed anew. As on the server, its matrix takes up a translation and gives way to a rotation or scale. */
function placed(node: SceneNode, fields: Omit<NodeEdit, 'node'>): SceneNode {
  const item = { ...node, ...fields };
  if (!item.matrix) return item;
  const { matrix, ...withoutMatrix } = item;
  if (fields.rotation || fields.scale) return withoutMatrix;
  const moved: typeof matrix = [...matrix];
  moved.splice(12, 3, ...item.translation);
  return { ...item, matrix: moved };
}

/** The scene with one edit applied. Pure. */
export function withEdit(scene: SceneMessage, edit: Edit): SceneMessage {
  switch (edit.target) {
    case 'material': {
      const { target: _, material, ...fields } = edit;
      return { ...scene, materials: replaceAt(scene.materials, material, fields) };
    }
    case 'light': {
      const { target: _, light, ...fields } = edit;
      return { ...scene, lights: replaceAt(scene.lights, light, fields) };
    }
    case 'node': {
      const { target: _, node, ...fields } = edit;
      return { ...scene, nodes: scene.nodes.map((item, i) => (i === node ? placed(item, fields) : item)) };
    }
    case 'environment': {
      const { target: _, ...fields } = edit;
      const hasImage = fields.image === undefined ? {} : { hasImage: fields.image !== '' };
      return { ...scene, environment: { ...scene.environment, ...fields, ...hasImage } };
    }
    case 'camera':
      return { ...scene, view: { ...scene.view, ...edit.view } };
    case 'resolve': {
      const { target: _, ...fields } = edit;
      return { ...scene, resolve: { ...scene.resolve, ...fields } };
    }
    case 'technique': {
      const technique = edit.technique ?? scene.technique;
      // Another technique begins with its own defaults, whatever its predecessor's parameters of the same names were.
      const kept = technique === scene.technique ? scene.parameters : {};
      return { ...scene, technique, parameters: { ...kept, ...edit.parameters } };
    }
    case 'image':
      return { ...scene, width: edit.width, height: edit.height };
  }
}
