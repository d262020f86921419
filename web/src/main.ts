/** Puts the house together: stream worker, model, camera, panels. */
import { bindControls } from './camera/controls';
import { ObjectMover } from './camera/object_mover';
import { CameraRig } from './camera/rig';
import { boundsOf, poseFromView, poseOfCamera, viewFromPose } from './camera/scene_pose';
import type { ConnectionState, FrameReport, Outgoing } from './channel';
import { nowMs } from './clock';
import { Bar } from './panels/bar';
import { HistoryControls, type Direction } from './panels/history_controls';
import { Inspector } from './panels/inspector';
import { Ledger } from './panels/ledger';
import { nameOf } from './panels/names';
import { RenderPanel } from './panels/render_panel';
import { bindSceneName, ScenePanel } from './panels/scene_panel';
import { Stage } from './panels/stage';
import { StatsPanel } from './panels/stats_panel';
import { bindTabs } from './panels/tabs';
import type { Edit, FrameHeader, Picked, SceneMessage, ServerMessage } from './protocol/messages.gen';
import { EditDesk, type Outcome } from './state/edit_desk';
import { EditHistory } from './state/edit_history';
import { Model } from './state/model';
import { Statistics } from './state/statistics';
import { StreamLink } from './stream_link';
import { makeTestHook, remember } from './test_hook';
import { Announcer } from './ui/announcer';
import { setText } from './ui/dom';
import { formatError, formatNumber, formatSamples } from './ui/format';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const requestFrame = (callback: (now: number) => void): void => void requestAnimationFrame(callback);
// Requests that are no edits travel under these tickets: the first where nobody waits for the answer.
const kNoTicket = 0;
const kFramingTicket = -1;
// The browser reads a download after the click; its bytes stay for so long.
const kDownloadMs = 30_000;

const model = new Model();
const statistics = new Statistics();
const announcer = new Announcer((text) => setText(byId('announcer'), text));
const ledger = new Ledger(byId('ledger'));
const stage = new Stage(byId('stage'), byId('stale'), byId('marker'), model);
const desk = new EditDesk({
  show: (edit) => model.applyLocally(edit),
  post: (ticket, message) => link.send(ticket, message),
  requestFrame,
  now: nowMs,
  onOutcome,
});
const history = new EditHistory({
  scene: () => model.scene,
  apply: (label, change) => desk.set(label, change),
  onChange: () => historyControls.show(),
});
const historyControls = new HistoryControls(byId('ledger'), history, travel);
const rig = new CameraRig({
  send: (pose) => desk.camera(viewFromPose(pose)),
  requestFrame,
  reducedMotion: () => matchMedia('(prefers-reduced-motion: reduce)').matches,
});
const mover = new ObjectMover(model, rig, edit, (why) => tell(why, true));
const link = new StreamLink(byId<HTMLCanvasElement>('picture'), socketUrl(), tokenOfAddress(), {
  onState,
  onMessage,
  onFrame,
  onFile,
  onFault,
  onSent,
});
const hook = makeTestHook(model, statistics, rig, desk, link);
window.limn = hook;
const bar = new Bar(byId('connection'), byId('phase'), model, () => link.retry());

bindTabs(byId('tabs'), document.body);
bindSceneName(byId('scene-name'), model);
new ScenePanel(byId('scene'), model, (uri) => request({ op: 'load', uri }), useCamera);
new StatsPanel(byId('stats'), model, statistics);
new Inspector(byId('inspector'), model, edit);
new RenderPanel(byId('render'), model, {
  edit,
  setFieldOfView: (yfov) => whenConnected(() => rig.setFieldOfView(yfov)),
  saveExr: () => request({ op: 'save' }),
  savePng: () => void savePng(),
  follow: (label, change) => desk.set(label, change),
  // Not the stage's own: an error that wraps in the ledger changes that, and is no wish for another picture.
  onWindowResize: (callback) => window.addEventListener('resize', callback),
  stageSize: () => ({
    width: stage.element.clientWidth * devicePixelRatio,
    height: stage.element.clientHeight * devicePixelRatio,
  }),
});
bindControls(stage.element, {
  pictureHeight: () => stage.shown().height,
  orbit: (yaw, pitch) => whenConnected(() => rig.orbit(yaw, pitch)),
  pan: (right, up) => whenConnected(() => rig.pan(right, up)),
  dolly: (factor) => whenConnected(() => rig.dolly(factor)),
  moveObject: (right, up) => whenConnected(() => mover.move(right, up)),
  // Where all is after an edit, only the server knows.
  frame: () => whenConnected(() => link.send(kFramingTicket, { op: 'describe' })),
  centerPicked: () => whenConnected(() => rig.centerPicked()),
  reset: () => whenConnected(() => rig.reset()),
  click: pick,
});
let homeOf = ''; // name of the scene whose first view the rig remembers
let framingSeq: number | null = null; // of the description that is asked for to frame what it tells of
model.on('scene', adoptScene);

/** The socket stands beside the page, whatever path the server is mounted on. */
function socketUrl(): string {
  const url = new URL('ws', document.baseURI);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = url.hash = '';
  return url.href;
}

/** A token given as #token=... stays out of requests and server logs. */
function tokenOfAddress(): string | null {
  return new URLSearchParams(location.hash.slice(1)).get('token');
}

/** An edit by hand: shown at once, sent with the next display frame, and remembered. */
function edit(label: string, change: Edit): void {
  whenConnected(() => history.edit(label, change));
}

/** Undoes or redoes an edit; the line under the picture then tells what it cost. */
function travel(direction: Direction): void {
  whenConnected(() => {
    const label = history[direction]();
    if (label === null) tell(`Nothing to ${direction}`);
    else announcer.say(`${direction}: ${label}`);
  });
}

/** Writes a line under the picture and speaks it. */
function tell(text: string, bad = false): void {
  ledger.say(text, bad);
  announcer.say(text);
}

function request(message: Outgoing): void {
  whenConnected(() => link.send(kNoTicket, message));
}

/** Without a connection nothing is changed here either, and the person is told. */
function whenConnected(action: () => void): void {
  if (model.connected()) {
    action();
    return;
  }
  tell('Not sent: there is no connection to the server', true);
  model.showAgain();
}

function pick(clientX: number, clientY: number): void {
  const pixel = stage.pixelAt(clientX, clientY);
  if (!pixel) return;
  stage.mark(pixel);
  request({ op: 'pick', ...pixel });
}

function useCamera(index: number): void {
  const pose = model.scene ? poseOfCamera(model.scene, index) : null;
  if (pose) whenConnected(() => rig.lookFrom(pose));
}

function adoptScene(scene: SceneMessage): void {
  const fresh = scene.cause === 'loaded' || scene.cause === 'joined';
  if (scene.cause === 'loaded' || scene.name !== homeOf) rig.forgetHome();
  history.onScene(scene);
  homeOf = scene.name;
  // A description that was made before our newest camera edit must not throw the camera back.
  if (fresh || (!rig.busy() && !desk.cameraPending())) rig.adopt(poseFromView(scene.view));
  rig.setBounds(boundsOf(scene));
  if (scene.seq === undefined || scene.seq !== framingSeq) return;
  framingSeq = null;
  rig.frame();
}

function onSent(ticket: number, seq: number | null, reason: string): void {
  if (ticket === kFramingTicket) framingSeq = seq;
  else desk.onSent(ticket, seq, reason);
}

function onState(state: ConnectionState): void {
  const was = model.connection.kind;
  if (was === 'connected' && state.kind !== 'connected') {
    desk.onDisconnected();
    framingSeq = null;
  }
  if (state.kind === 'connected') statistics.onConnected();
  model.setConnection(state);
  if (state.kind !== was) announcer.say('reason' in state ? `${state.kind}: ${state.reason}` : state.kind);
}

function onMessage(message: ServerMessage): void {
  switch (message.op) {
    case 'hello':
      model.setHello(message);
      break;
    case 'scene':
      model.setScene(desk.ahead(message));
      break;
    case 'status':
      model.setStatus(message);
      statistics.onStatus(message, nowMs());
      break;
    case 'ack':
      remember(hook.acks, message);
      desk.onAck(message);
      break;
    case 'picked':
      remember(hook.picks, message);
      onPicked(message);
      break;
    case 'loaded':
      tell(`Loaded in ${formatNumber(message.seconds, 3)} s`);
      break;
    case 'bye':
      tell(`The server says good-bye: ${message.reason}`, true);
      break;
    case 'error':
      if (!desk.onError(message)) tell(`${message.message}${message.place ? ` (${message.place})` : ''}`, true);
      break;
    default:
      break;
  }
}

function onPicked(picked: Picked): void {
  if (!picked.hit || picked.node === undefined) {
    rig.setPivot(null);
    model.select({ kind: 'environment' });
    tell('Picked: nothing but the environment');
    return;
  }
  rig.setPivot(picked.posW ? { point: picked.posW, node: picked.node } : null);
  const material = picked.material === undefined ? {} : { material: picked.material };
  model.select({ kind: 'node', node: picked.node, ...material });
  const node = nameOf(model.scene?.nodes[picked.node]?.name, 'Node', picked.node);
  const made =
    picked.material === undefined
      ? 'the default material'
      : nameOf(model.scene?.materials[picked.material]?.name, 'Material', picked.material);
  tell(`Picked: ${node}, made of ${made}`);
}

function onOutcome(outcome: Outcome): void {
  remember(hook.outcomes, outcome);
  ledger.showOutcome(outcome);
  if (outcome.kind === 'applied') {
    // A technique brings its own parameters, which only the server knows.
    if (outcome.latencyMs !== undefined && outcome.label === 'Technique') request({ op: 'describe' });
    return;
  }
  announcer.say(`${outcome.label} failed`);
  // What was shown in advance is not so; the server's own description puts it right.
  if (model.connected()) request({ op: 'describe' });
}

function onFrame(frame: FrameReport): void {
  const before = statistics.last?.header.phase;
  statistics.onFrame(frame);
  if (frame.dropped) return;
  const { header } = frame;
  stage.onPicture(header.fullWidth, header.fullHeight);
  rig.aspect = stage.aspect();
  bar.showFrame(frame);
  statistics.onLatencies(desk.onFrame(frame));
  const error = Number.isFinite(header.estimatedError) ? `, error ${formatError(header.estimatedError)}` : '';
  ledger.showFigures(`${formatSamples(header.meanSamples)} samples${error}`);
  if (header.phase === 'converged' && before !== 'converged') announcer.say('The picture has converged');
  hook.frame = frame;
  remember(hook.presented, header);
}

function onFile(header: FrameHeader, bytes: Uint8Array): void {
  download(new Blob([bytes as Uint8Array<ArrayBuffer>], { type: 'application/octet-stream' }), header.encoding);
}

/** The picture as it is shown, whatever the connection does. */
async function savePng(): Promise<void> {
  const png = await link.png();
  if (png) download(png, 'png');
}

/** Lets the browser keep a file that is named after the scene. */
function download(file: Blob, extension: string): void {
  const url = URL.createObjectURL(file);
  const anchor = document.createElement('a');
  anchor.href = url;
  anchor.download = `${(model.scene?.name ?? 'limn').replace(/\.[^.]*$/, '')}.${extension}`;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(url), kDownloadMs);
}

function onFault(text: string): void {
  remember(hook.faults, text);
  tell(text, true);
}
