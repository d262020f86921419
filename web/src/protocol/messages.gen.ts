// Generated from protocol/schema.json by protocol/generate.py --typescript.

export const kSubprotocol = "limn.v1";
export const kVersion = 1;

export const kMaxControlBytes = 1048576;  /** longest text message to the server [byte] */
export const kMaxServerTextBytes = 67108864;  /** longest text message from the server [byte] */
export const kMaxFragmentBytes = 65536;  /** longest WebSocket fragment that the server sends [byte] */
export const kMaxFragments = 4096;  /** fragments of one message to the server */
export const kFramesInFlight = 2;  /** image frames sent and not acknowledged */
export const kMaxEditsPerBatch = 1024;  /** edits in a batch */
export const kMaxImageSide = 16384;  /** width and height of a picture, of the protocol; the server announces its own [pixel] */
export const kMaxJsonDepth = 16;  /** nesting of a text message */
export const kHelloSeconds = 5;  /** from the handshake to the client's hello [s] */
export const kAckSeconds = 10;  /** without an acknowledgement while frames are in flight [s] */

export type ErrorCode = "bad-message" | "out-of-range" | "unknown-op" | "unknown-name" | "unknown-technique" | "unknown-parameter" | "bad-seq" | "bad-ack" | "hello-first" | "version" | "busy" | "limit" | "bad-file" | "unsupported" | "io" | "path" | "device" | "device-lost" | "internal";

export const kCloseCodes: { [code: number]: string } = { 1000: "after bye", 1001: "the server is draining", 1002: "the WebSocket protocol was broken", 1003: "a binary message came from a client", 1007: "a text message was not UTF-8", 1008: "policy: no hello in time, acknowledgements missing for too long", 1009: "a message was longer than maxControlBytes", 1011: "a fault of the server's own, or a lost device" };

/** What an edit costs, cheapest first. */
export type CostClass = "none" | "display-only" | "relight" | "re-gather" | "rebuild" | "reload";
export const kCostClasss: readonly CostClass[] = ["none", "display-only", "relight", "re-gather", "rebuild", "reload"];

/** How far a picture is. */
export type Phase = "coarse" | "converging" | "converged";
export const kPhases: readonly Phase[] = ["coarse", "converging", "converged"];

/** How radiance becomes display values. */
export type ToneMap = "pbr-neutral" | "aces" | "agx" | "linear";
export const kToneMaps: readonly ToneMap[] = ["pbr-neutral", "aces", "agx", "linear"];

/** What of the film is shown. */
export type ResolveView = "beauty" | "direct" | "indirect" | "albedo" | "normal" | "depth" | "samples" | "placement";
export const kResolveViews: readonly ResolveView[] = ["beauty", "direct", "indirect", "albedo", "normal", "depth", "samples", "placement"];

/** glTF alphaMode. */
export type AlphaMode = "opaque" | "mask" | "blend";
export const kAlphaModes: readonly AlphaMode[] = ["opaque", "mask", "blend"];

/** KHR_lights_punctual type. */
export type LightType = "point" | "spot" | "directional";
export const kLightTypes: readonly LightType[] = ["point", "spot", "directional"];

/** Type of a technique's parameter; its value always travels as a number. */
export type ParameterType = "integer" | "real" | "boolean";
export const kParameterTypes: readonly ParameterType[] = ["integer", "real", "boolean"];

/** How a panel shows an editable field. */
export type FieldKind = "number" | "choice" | "color" | "color-alpha" | "vector" | "quaternion" | "text" | "parameters";
export const kFieldKinds: readonly FieldKind[] = ["number", "choice", "color", "color-alpha", "vector", "quaternion", "text", "parameters"];

/** What a binary frame carries. */
export type FrameKind = "image" | "file";
export const kFrameKinds: readonly FrameKind[] = ["image", "file"];

/** How the payload is encoded. */
export type Encoding = "jpeg" | "png" | "exr" | "half-tiles";
export const kEncodings: readonly Encoding[] = ["jpeg", "png", "exr", "half-tiles"];

/** Why a scene message was sent. */
export type SceneCause = "asked" | "joined" | "loaded" | "edited";
export const kSceneCauses: readonly SceneCause[] = ["asked", "joined", "loaded", "edited"];

/** Where the picture is taken from. */
export interface View {
  eye: [number, number, number];  /** position, world space [m] */
  target: [number, number, number];  /** the point looked at and orbited about [m] */
  up: [number, number, number];  /** any length but 0, not along the line of sight */
  perspective?: boolean;  /** false: orthographic */
  yfov?: number;  /** vertical field of view [rad] */
  ymag?: number;  /** orthographic half height [m] */
  znear?: number;  /** hits nearer than this are clipped [m] */
}

/** Fields of a material; absent ones keep their value. */
export interface MaterialEdit {
  material: number;  /** index */
  baseColor?: [number, number, number, number];  /** linear Rec. 709 and alpha */
  metallic?: number;  /** 0 dielectric, 1 metal */
  roughness?: number;  /** GGX alpha is its square */
  emission?: [number, number, number];  /** radiance, both faces [W·sr⁻¹·m⁻²] */
  ior?: number;  /** index of refraction */
  transmission?: number;  /** share of light that enters */
  thickness?: number;  /** 0: thin-walled; above: the mesh bounds a volume [m] */
  attenuationDistance?: number;  /** where attenuationColor is reached; 0: no attenuation [m] */
  attenuationColor?: [number, number, number];  /** of white light after attenuationDistance */
  specular?: number;  /** strength of the dielectric reflection */
  specularColor?: [number, number, number];  /** tint of the dielectric reflection at normal incidence */
  clearcoat?: number;  /** coverage of the coat */
  clearcoatRoughness?: number;  /** roughness of the coat */
  normalScale?: number;  /** strength of the normal map */
  alphaCutoff?: number;  /** threshold of alphaMode mask */
  alphaMode?: AlphaMode;  /** glTF alphaMode */
}

/** Fields of a punctual light; absent ones keep their value. */
export interface LightEdit {
  light: number;  /** index */
  color?: [number, number, number];  /** linear Rec. 709 */
  intensity?: number;  /** point, spot: radiant intensity; directional: irradiance [W/sr or W/m²] */
  range?: number;  /** 0: infinite [m] */
  innerConeAngle?: number;  /** full intensity inside [rad] */
  outerConeAngle?: number;  /** dark outside [rad] */
}

/** A node's transform against its parent; absent parts keep their value. Of a node that a matrix places, a translation replaces the fourth column and keeps the others; a rotation or a scale puts the three parts in the matrix's place. */
export interface NodeEdit {
  node: number;  /** index */
  translation?: [number, number, number];  /** against the parent [m] */
  rotation?: [number, number, number, number];  /** x, y, z, w as in glTF; normalised on application */
  scale?: [number, number, number];  /** negative mirrors */
}

/** Light from infinitely far away; absent fields keep their value. */
export interface EnvironmentEdit {
  radiance?: [number, number, number];  /** multiplies the image where there is one [W·sr⁻¹·m⁻²] */
  rotation?: number;  /** about +y [rad] */
  image?: string;  /** path of an .hdr or .exr latitude-longitude image under the server's asset root, which is read first; empty: none any more */
}

/** The view, in a batch. */
export interface CameraEdit {
  view: View;  /** absent lens fields keep their value */
}

/** The technique and its parameters, by announced name. */
export interface TechniqueEdit {
  technique?: string;  /** absent: the present one */
  parameters?: { [name: string]: number };  /** values by name; absent ones keep theirs, or take their default when the technique changes */
}

/** How radiance is shown; never restarts sampling. */
export interface ResolveEdit {
  exposure?: number;  /** radiance is multiplied by 2^exposure [EV] */
  toneMap?: ToneMap;  /** one of those announced */
  view?: ResolveView;  /** what is shown */
}

/** Size of the picture. */
export interface ImageEdit {
  width: number;  /** the server's own limit is announced [pixel] */
  height: number;  /** the server's own limit is announced [pixel] */
}

/** What the server keeps to, and closes connections over. */
export interface Limits {
  maxControlBytes: number;  /** longest text message to the server [byte] */
  maxFragmentBytes: number;  /** longest WebSocket fragment that the server sends [byte] */
  framesInFlight: number;  /** image frames sent and not acknowledged */
  maxEditsPerBatch: number;  /** edits in a batch */
  maxImageSide: number;  /** width and height of the picture [pixel] */
  maxClients: number;  /** connections at a time */
  messagesPerSecond: number;  /** sustained rate a client may send at; faster ones are slowed down, not closed [1/s] */
}

/** One knob of a technique. */
export interface TechniqueParameter {
  name: string;  /** for set */
  description: string;  /** one sentence for people */
  unit: string;  /** "samples", "bounces", "1" ... */
  type: ParameterType;  /** how to show it */
  minimum: number;  /** least value */
  maximum: number;  /** greatest value */
  default: number;  /** value after the technique was chosen */
  cost: CostClass;  /** what a change restarts */
}

/** A technique on offer. */
export interface Technique {
  name: string;  /** for set */
  title: string;  /** for people */
  description: string;  /** one or two sentences */
  biased: boolean;  /** true: converges to something near the truth */
  parameters: TechniqueParameter[];  /** in the order in which to show them */
}

/** One field of an edit, so that panels can be built from it. */
export interface EditableField {
  name: string;  /** as in set and in the scene message */
  kind: FieldKind;  /** how to show it */
  unit: string;  /** "1" for plain numbers */
  description: string;  /** one sentence for people */
  minimum?: number;  /** least value taken, of each component */
  maximum?: number;  /** greatest value taken, of each component */
  softMinimum?: number;  /** where a slider should begin */
  softMaximum?: number;  /** where a slider should end */
  choices?: string[];  /** of kind choice */
}

/** What set can change of one target. */
export interface EditableTarget {
  target: string;  /** as in set */
  fields: EditableField[];  /** in the order in which to show them */
}

/** A material as it is now; its index is its place in the list. */
export interface Material {
  name: string;  /** may be empty */
  baseColor: [number, number, number, number];  /** linear Rec. 709, alpha; multiplies the texture */
  metallic: number;  /** 0..1 */
  roughness: number;  /** 0..1 */
  emission: [number, number, number];  /** radiance [W·sr⁻¹·m⁻²] */
  ior: number;  /** index of refraction */
  transmission: number;  /** 0..1 */
  thickness: number;  /** 0: thin-walled [m] */
  attenuationDistance: number;  /** 0: none [m] */
  attenuationColor: [number, number, number];  /** linear Rec. 709 */
  specular: number;  /** 0..1 */
  specularColor: [number, number, number];  /** linear Rec. 709 */
  clearcoat: number;  /** 0..1 */
  clearcoatRoughness: number;  /** 0..1 */
  normalScale: number;  /** strength of the normal map */
  alphaCutoff: number;  /** threshold of mask */
  alphaMode: AlphaMode;  /** glTF alphaMode */
  doubleSided: boolean;  /** cannot be edited */
  unlit: boolean;  /** cannot be edited */
  textures: string[];  /** fields that an image multiplies: "baseColor", "metallicRoughness", "normal" ... */
}

/** A punctual light as it is now; its index is its place in the list. */
export interface Light {
  name: string;  /** may be empty */
  type: LightType;  /** cannot be edited */
  color: [number, number, number];  /** linear Rec. 709 */
  intensity: number;  /** point, spot: radiant intensity; directional: irradiance [W/sr or W/m²] */
  range: number;  /** 0: infinite [m] */
  innerConeAngle: number;  /** spot [rad] */
  outerConeAngle: number;  /** spot [rad] */
}

/** A node as it is now; its index is its place in the list. */
export interface SceneNode {
  name: string;  /** may be empty */
  parent?: number;  /** absent: a root */
  translation: [number, number, number];  /** against the parent [m] */
  rotation: [number, number, number, number];  /** x, y, z, w */
  scale: [number, number, number];  /** against the parent */
  matrix?: [number, number, number, number, number, number, number, number, number, number, number, number, number, number, number, number];  /** column-major; present: it is used and the three above are not */
  mesh?: number;  /** index into meshes */
  camera?: number;  /** index into cameras */
  light?: number;  /** index into lights */
}

/** A lens of the file. */
export interface Camera {
  name: string;  /** may be empty */
  perspective: boolean;  /** false: orthographic */
  yfov: number;  /** vertical field of view [rad] */
  ymag: number;  /** orthographic half height [m] */
  znear: number;  /** near clip [m] */
}

/** Light from infinitely far away. */
export interface Environment {
  radiance: [number, number, number];  /** constant, or the factor of the image [W·sr⁻¹·m⁻²] */
  rotation: number;  /** about +y [rad] */
  hasImage: boolean;  /** a latitude-longitude image is multiplied by radiance */
  image: string;  /** its name, as set takes it; empty: none */
}

/** How radiance is shown. */
export interface Resolve {
  exposure: number;  /** radiance is multiplied by 2^exposure [EV] */
  toneMap: ToneMap;  /** the one in use */
  view: ResolveView;  /** what is shown */
}

/** Something the file uses and the renderer does not support. */
export interface Unsupported {
  feature: string;  /** extension, primitive mode, attribute ... */
  materials: string[];  /** names of the affected materials, or #index */
  note: string;  /** what happens instead */
}

/** What was found in the file. */
export interface LoadReport {
  unsupported: Unsupported[];  /** never ignored silently */
  notes: string[];  /** what was added so that the scene can be seen, and the like */
  triangles: number;  /** of all meshes */
  degenerateTriangles: number;  /** without area */
  vertices: number;  /** of all meshes */
  imageBytes: number;  /** decoded [byte] */
}

/** One edit. */
export type Edit = ({ target: "material" } & MaterialEdit) | ({ target: "light" } & LightEdit) | ({ target: "node" } & NodeEdit) | ({ target: "environment" } & EnvironmentEdit) | ({ target: "camera" } & CameraEdit) | ({ target: "technique" } & TechniqueEdit) | ({ target: "resolve" } & ResolveEdit) | ({ target: "image" } & ImageEdit);

/** The first message of a client. Answered by hello, then scene and status. */
export interface ClientHello {
  op: "hello";
  seq: number;  /** rises from message to message of a client */
  version: number;  /** of the protocol; 1 */
  client: string;  /** name and version of the program, for logs */
  encodings?: Encoding[];  /** those the client can decode; absent: jpeg and png */
  watch?: boolean;  /** false: no image frames are wanted; absent: true */
}

/** Answered by pong. */
export interface Ping {
  op: "ping";
  seq: number;  /** rises from message to message of a client */
}

/** Loads a scene. Answered by loaded or error; the present scene stays until the new one is there. */
export interface Load {
  op: "load";
  seq: number;  /** rises from message to message of a client */
  uri: string;  /** path of a .gltf or .glb under the server's asset root */
}

/** Moves the view. Answered by ack. A later one replaces an earlier one that was not applied yet. */
export type SetCamera = {
  op: "camera";
  seq: number;  /** rises from message to message of a client */
} & View;

/** One edit. Answered by ack. */
export type SetMessage = {
  op: "set";
  seq: number;  /** rises from message to message of a client */
} & Edit;

/** Edits that apply together or not at all. Answered by one ack. */
export interface Batch {
  op: "batch";
  seq: number;  /** rises from message to message of a client */
  edits: Edit[];  /** applied in order; the later edit of a field wins */
}

/** What is under a pixel. Answered by picked. */
export interface Pick {
  op: "pick";
  seq: number;  /** rises from message to message of a client */
  x: number;  /** of the full picture, 0 on the left [pixel] */
  y: number;  /** of the full picture, 0 on top [pixel] */
}

/** A frame was shown or dropped; gives its credit back. Not answered. */
export interface AckFrame {
  op: "ackFrame";
  seq: number;  /** rises from message to message of a client */
  frameId: number;  /** from the frame's header */
  receiveMs?: number;  /** from the first byte to the last, or 0 [ms] */
  decodeMs?: number;  /** from the last byte to the canvas [ms] */
  dropped: boolean;  /** true: a newer one took its place and it was never shown */
}

/** Asks for an OpenEXR file of the film as it is. Answered by saved and one binary frame of kind file. */
export interface Save {
  op: "save";
  seq: number;  /** rises from message to message of a client */
  layers?: string[];  /** of those announced; absent: all */
}

/** Answered by scene. */
export interface Describe {
  op: "describe";
  seq: number;  /** rises from message to message of a client */
}

/** Answered by waited, once the film is so far. With both fields: when both are reached; with neither: at convergence, which ends every wait. An edit meanwhile starts the count again. */
export interface Wait {
  op: "wait";
  seq: number;  /** rises from message to message of a client */
  steps?: number;  /** passes since the last restart */
  error?: number;  /** upper end of the 95 % interval of relMSE at or below this */
}

/** The client will close. Answered by bye, then close 1000. */
export interface ClientBye {
  op: "bye";
  seq: number;  /** rises from message to message of a client */
}

/** The first message of a server. */
export interface ServerHello {
  op: "hello";
  seq: number;  /** of the client's hello */
  version: number;  /** of the protocol; 1 */
  server: string;  /** name and version of the program */
  device: string;  /** name and driver of the device */
  clientId: number;  /** the server's number for this connection */
  limits: Limits;  /** kept by the server */
  techniques: Technique[];  /** in the order in which to offer them; the first is the default */
  toneMaps: ToneMap[];  /** that set resolve takes */
  encodings: Encoding[];  /** that frames may have on this connection */
  layers: string[];  /** that save takes */
  stages: string[];  /** what stageMs of a frame's header counts, in order */
  editable: EditableTarget[];  /** what set takes */
}

/** Slow-changing facts, a few times a second while they change. */
export interface Status {
  op: "status";
  phase: Phase;  /** of the film */
  idle: boolean;  /** true: the loop sleeps */
  steps: number;  /** passes since the restart */
  meanSamples: number;  /** per pixel */
  estimatedError?: number;  /** relMSE; absent until it can be told */
  errorLow?: number;  /** 95 % interval; absent until it can be told */
  errorHigh?: number;  /** 95 % interval; absent until it can be told */
  raysPerSecond: number;  /** of late [1/s] */
  secondsSinceRestart: number;  /** wall clock [s] */
  discardedSamples: number;  /** that were not finite or negative, since the restart */
  discardedShare: number;  /** of the samples taken since the restart, 0..1 */
  editsApplied: number;  /** since the server began */
  restarts: number;  /** since the server began */
  framesPublished: number;  /** by the renderer, since the server began */
  quanta: number;  /** of work, since the server began */
  pipelinesCreated: number;  /** since the server began; constant after warm-up */
  technique: string;  /** in use */
  ran: string[];  /** passes that this scene needs */
  leftOut: string[];  /** passes that it does not need */
  memory: { [name: string]: number };  /** on the device, by owner [byte] */
  stageMs: { [name: string]: number };  /** by stage: build and warmUp of the scene, the others since the restart [ms] */
  figures: { [name: string]: number };  /** about the parts of the technique in use, by name */
  clients: number;  /** connected */
  framesSent: number;  /** to this client */
  framesReplaced: number;  /** by newer ones before they were sent to this client */
}

/** An edit was applied, or replaced by a later one. */
export interface Ack {
  op: "ack";
  seq: number;  /** of the edit */
  cost: CostClass;  /** what it cost */
  sceneRevision: number;  /** that holds it; a frame with this one or a later one shows it */
  viewRevision: number;  /** that holds it */
  superseded: boolean;  /** true: a later camera edit took its place before it was applied */
}

/** A message could not be taken; nothing has changed. The connection stays open unless a close code says otherwise. */
export interface ErrorMessage {
  op: "error";
  seq?: number;  /** of the message, where it could be read */
  code: string;  /** one of the error codes */
  message: string;  /** one sentence for people */
  place?: string;  /** "seq 12 /edits/0/roughness", or a file and JSON pointer */
}

/** The answer to ping. */
export interface Pong {
  op: "pong";
  seq: number;  /** of the ping */
  serverSeconds: number;  /** the server's monotonic clock [s] */
}

/** The scene without its texels and vertices. */
export interface SceneMessage {
  op: "scene";
  seq?: number;  /** of the describe; absent when it was not asked for */
  cause: SceneCause;  /** why it was sent */
  name: string;  /** of the file */
  hash: string;  /** of the scene's content */
  sceneRevision: number;  /** of this description */
  viewRevision: number;  /** of this description */
  materials: Material[];  /** by index */
  lights: Light[];  /** by index */
  nodes: SceneNode[];  /** by index */
  meshes: string[];  /** names, by index */
  cameras: Camera[];  /** by index */
  environment: Environment;  /** as it is now */
  view: View;  /** with every field */
  resolve: Resolve;  /** as it is now */
  technique: string;  /** in use */
  parameters: { [name: string]: number };  /** of the technique in use */
  width: number;  /** of the picture [pixel] */
  height: number;  /** of the picture [pixel] */
  boundsLow: [number, number, number];  /** world space [m] */
  boundsHigh: [number, number, number];  /** world space [m] */
  report: LoadReport;  /** of loading */
}

/** A load is done. Every client is sent scene as well. */
export interface Loaded {
  op: "loaded";
  seq: number;  /** of the load */
  seconds: number;  /** that loading took [s] */
  sceneRevision: number;  /** of the new scene */
  hash: string;  /** of the scene's content */
}

/** What is under the pixel; without its optional fields where the ray leaves the scene. */
export interface Picked {
  op: "picked";
  seq: number;  /** of the pick */
  hit: boolean;  /** whether anything is there */
  node?: number;  /** index */
  material?: number;  /** index; absent: the default material */
  primitive?: number;  /** of the node's mesh */
  posW?: [number, number, number];  /** world space [m] */
  normalW?: [number, number, number];  /** geometric, world space, unit length */
  distance?: number;  /** from the eye [m] */
}

/** A file is on its way: the next binary frame of kind file with this seq holds it. */
export interface Saved {
  op: "saved";
  seq: number;  /** of the save */
  bytes: number;  /** of the file [byte] */
  encoding: Encoding;  /** exr */
}

/** The film is as far as was asked. */
export interface Waited {
  op: "waited";
  seq: number;  /** of the wait */
  steps: number;  /** passes since the restart */
  filmHash: string;  /** of mean, second moment and count of every pixel */
  estimatedError?: number;  /** relMSE; absent until it can be told */
  errorLow?: number;  /** 95 % interval; absent until it can be told */
  errorHigh?: number;  /** 95 % interval; absent until it can be told */
}

/** The server will close. */
export interface ServerBye {
  op: "bye";
  reason: string;  /** one sentence for people */
}

/** Everything a client sends. */
export type ClientMessage = ClientHello | Ping | Load | SetCamera | SetMessage | Batch | Pick | AckFrame | Save | Describe | Wait | ClientBye;

/** Everything a server sends as text. */
export type ServerMessage = ServerHello | Status | Ack | ErrorMessage | Pong | SceneMessage | Loaded | Picked | Saved | Waited | ServerBye;

export const kFrameHeaderBytes = 116;
export const kFrameMoving = 1;  /** an edit is fresh: the next frames will replace this one soon */
export const kFrameLossless = 2;  /** the payload holds the film's pixels exactly */
export const kFrameFinal = 4;  /** nothing more comes until an edit */
export const kFrameFull = 8;  /** the rectangle is the whole picture */

/** What stands before the payload of a binary message. */
export interface FrameHeader {
  kind: FrameKind;  /** what the payload is */
  encoding: Encoding;  /** how it is encoded */
  flags: number;  /** see frame flags */
  phase: Phase;  /** how far the picture is */
  quality: number;  /** JPEG quality, 0 when lossless */
  stageCount: number;  /** valid entries of stageMs */
  frameId: number;  /** rises by at least 1 a frame on a connection; 0 for files */
  ackSeq: number;  /** newest seq of this client's edits that the picture shows, 0 for none; for files the seq of the save */
  sceneRevision: number;  /** of the picture */
  viewRevision: number;  /** of the picture (camera, size) */
  x: number;  /** left edge of the rectangle in the full picture [pixel] */
  y: number;  /** top edge [pixel] */
  width: number;  /** of the rectangle in the full picture [pixel] */
  height: number;  /** of the rectangle in the full picture [pixel] */
  fullWidth: number;  /** of the full picture [pixel] */
  fullHeight: number;  /** of the full picture [pixel] */
  imageWidth: number;  /** of the decoded payload; smaller than the rectangle while the resolution is divided [pixel] */
  imageHeight: number;  /** of the decoded payload [pixel] */
  steps: number;  /** passes since the restart */
  replaced: number;  /** frames for this client that newer ones replaced before they were sent, in all */
  gatheredShare: number;  /** share of pixels with a sample of their own, 0..1 */
  meanSamples: number;  /** per pixel */
  estimatedError: number;  /** relMSE; +infinity until it can be told */
  errorLow: number;  /** 95 % interval */
  errorHigh: number;  /** 95 % interval */
  msSinceEdit: number;  /** from receipt of the newest applied edit to publication [ms] */
  renderMs: number;  /** render time of this frame on the device [ms] */
  encodeMs: number;  /** encoding time [ms] */
  stageMs: number[];  /** by stage, named in hello [ms] */
  payloadBytes: number;  /** that follow the header [byte] */
  crc32c: number;  /** Castagnoli CRC of the payload */
}

/** Reads the header of a binary message. Throws ProtocolError. */
export function decodeFrameHeader(view: DataView): FrameHeader {
  if (view.byteLength < kFrameHeaderBytes) throw new ProtocolError("bad-message", "shorter than a frame header", `byte ${view.byteLength}`);
  if (view.getUint32(0, true) !== 827215180) throw new ProtocolError("bad-message", "magic is not 827215180", "byte 0");
  if (view.getUint8(4) !== 1) throw new ProtocolError("version", "version is not 1", "byte 4");
  if (view.getUint8(11) !== 0) throw new ProtocolError("bad-message", "reserved is not 0", "byte 11");
  const word = <T>(words: readonly T[], offset: number): T => {
    const value = words[view.getUint8(offset)];
    if (value === undefined) throw new ProtocolError("out-of-range", "unknown value", `byte ${offset}`);
    return value;
  };
  return {
    kind: word(kFrameKinds, 5),
    encoding: word(kEncodings, 6),
    flags: view.getUint8(7),
    phase: word(kPhases, 8),
    quality: view.getUint8(9),
    stageCount: view.getUint8(10),
    frameId: view.getUint32(12, true),
    ackSeq: view.getUint32(16, true),
    sceneRevision: view.getUint32(20, true),
    viewRevision: view.getUint32(24, true),
    x: view.getUint16(28, true),
    y: view.getUint16(30, true),
    width: view.getUint16(32, true),
    height: view.getUint16(34, true),
    fullWidth: view.getUint16(36, true),
    fullHeight: view.getUint16(38, true),
    imageWidth: view.getUint16(40, true),
    imageHeight: view.getUint16(42, true),
    steps: view.getUint32(44, true),
    replaced: view.getUint32(48, true),
    gatheredShare: view.getFloat32(52, true),
    meanSamples: view.getFloat32(56, true),
    estimatedError: view.getFloat32(60, true),
    errorLow: view.getFloat32(64, true),
    errorHigh: view.getFloat32(68, true),
    msSinceEdit: view.getFloat32(72, true),
    renderMs: view.getFloat32(76, true),
    encodeMs: view.getFloat32(80, true),
    stageMs: [view.getFloat32(84, true), view.getFloat32(88, true), view.getFloat32(92, true), view.getFloat32(96, true), view.getFloat32(100, true), view.getFloat32(104, true)],
    payloadBytes: view.getUint32(108, true),
    crc32c: view.getUint32(112, true),
  };
}

/** Writes a header, little-endian. Throws ProtocolError where a word is not one of the schema's. */
function encodeFrameHeader(header: FrameHeader, view: DataView): void {
  const index = <T>(words: readonly T[], word: T, offset: number): number => {
    const found = words.indexOf(word);
    if (found < 0) throw new ProtocolError("out-of-range", "unknown value", `byte ${offset}`);
    return found;
  };
  view.setUint32(0, 827215180, true);
  view.setUint8(4, 1);
  view.setUint8(5, index(kFrameKinds, header.kind, 5));
  view.setUint8(6, index(kEncodings, header.encoding, 6));
  view.setUint8(7, header.flags);
  view.setUint8(8, index(kPhases, header.phase, 8));
  view.setUint8(9, header.quality);
  view.setUint8(10, header.stageCount);
  view.setUint8(11, 0);
  view.setUint32(12, header.frameId, true);
  view.setUint32(16, header.ackSeq, true);
  view.setUint32(20, header.sceneRevision, true);
  view.setUint32(24, header.viewRevision, true);
  view.setUint16(28, header.x, true);
  view.setUint16(30, header.y, true);
  view.setUint16(32, header.width, true);
  view.setUint16(34, header.height, true);
  view.setUint16(36, header.fullWidth, true);
  view.setUint16(38, header.fullHeight, true);
  view.setUint16(40, header.imageWidth, true);
  view.setUint16(42, header.imageHeight, true);
  view.setUint32(44, header.steps, true);
  view.setUint32(48, header.replaced, true);
  view.setFloat32(52, header.gatheredShare, true);
  view.setFloat32(56, header.meanSamples, true);
  view.setFloat32(60, header.estimatedError, true);
  view.setFloat32(64, header.errorLow, true);
  view.setFloat32(68, header.errorHigh, true);
  view.setFloat32(72, header.msSinceEdit, true);
  view.setFloat32(76, header.renderMs, true);
  view.setFloat32(80, header.encodeMs, true);
  view.setFloat32(84, header.stageMs[0] as number, true);
  view.setFloat32(88, header.stageMs[1] as number, true);
  view.setFloat32(92, header.stageMs[2] as number, true);
  view.setFloat32(96, header.stageMs[3] as number, true);
  view.setFloat32(100, header.stageMs[4] as number, true);
  view.setFloat32(104, header.stageMs[5] as number, true);
  view.setUint32(108, header.payloadBytes, true);
  view.setUint32(112, header.crc32c, true);
}

const kEnums: { [name: string]: readonly string[] } = {
  CostClass: kCostClasss,
  Phase: kPhases,
  ToneMap: kToneMaps,
  ResolveView: kResolveViews,
  AlphaMode: kAlphaModes,
  LightType: kLightTypes,
  ParameterType: kParameterTypes,
  FieldKind: kFieldKinds,
  FrameKind: kFrameKinds,
  Encoding: kEncodings,
  SceneCause: kSceneCauses,
};

const kUnions: { [name: string]: { tag: string; members: { [word: string]: string } } } = {
  Edit: { tag: "target", members: { material: "MaterialEdit", light: "LightEdit", node: "NodeEdit", environment: "EnvironmentEdit", camera: "CameraEdit", technique: "TechniqueEdit", resolve: "ResolveEdit", image: "ImageEdit" } },
};

const kStructs: { [name: string]: readonly Field[] } = {
  View: [
    { name: "eye", type: "f64[3]" },
    { name: "target", type: "f64[3]" },
    { name: "up", type: "f64[3]" },
    { name: "perspective", type: "bool", optional: true },
    { name: "yfov", type: "f32", optional: true, min: 0.0001, max: 3.1405928 },
    { name: "ymag", type: "f32", optional: true, min: 1e-45, max: 3.4028235e+38 },
    { name: "znear", type: "f32", optional: true, min: 0, max: 3.4028235e+38 },
  ],
  MaterialEdit: [
    { name: "material", type: "u32" },
    { name: "baseColor", type: "f32[4]", optional: true, min: 0, max: 1 },
    { name: "metallic", type: "f32", optional: true, min: 0, max: 1 },
    { name: "roughness", type: "f32", optional: true, min: 0, max: 1 },
    { name: "emission", type: "f32[3]", optional: true, min: 0, max: 1000000000.0 },
    { name: "ior", type: "f32", optional: true, min: 1, max: 10 },
    { name: "transmission", type: "f32", optional: true, min: 0, max: 1 },
    { name: "thickness", type: "f32", optional: true, min: 0, max: 1000000000.0 },
    { name: "attenuationDistance", type: "f32", optional: true, min: 0, max: 1000000000.0 },
    { name: "attenuationColor", type: "f32[3]", optional: true, min: 0, max: 1 },
    { name: "specular", type: "f32", optional: true, min: 0, max: 1 },
    { name: "specularColor", type: "f32[3]", optional: true, min: 0, max: 10000.0 },
    { name: "clearcoat", type: "f32", optional: true, min: 0, max: 1 },
    { name: "clearcoatRoughness", type: "f32", optional: true, min: 0, max: 1 },
    { name: "normalScale", type: "f32", optional: true, min: -100, max: 100 },
    { name: "alphaCutoff", type: "f32", optional: true, min: 0, max: 1 },
    { name: "alphaMode", type: "AlphaMode", optional: true },
  ],
  LightEdit: [
    { name: "light", type: "u32" },
    { name: "color", type: "f32[3]", optional: true, min: 0, max: 1 },
    { name: "intensity", type: "f32", optional: true, min: 0, max: 1000000000000.0 },
    { name: "range", type: "f32", optional: true, min: 0, max: 1000000000.0 },
    { name: "innerConeAngle", type: "f32", optional: true, min: 0, max: 1.5707964 },
    { name: "outerConeAngle", type: "f32", optional: true, min: 0, max: 1.5707964 },
  ],
  NodeEdit: [
    { name: "node", type: "u32" },
    { name: "translation", type: "f64[3]", optional: true },
    { name: "rotation", type: "f64[4]", optional: true, min: -1000000.0, max: 1000000.0 },
    { name: "scale", type: "f64[3]", optional: true },
  ],
  EnvironmentEdit: [
    { name: "radiance", type: "f32[3]", optional: true, min: 0, max: 1000000000.0 },
    { name: "rotation", type: "f32", optional: true, min: -1000, max: 1000 },
    { name: "image", type: "string", optional: true, maxLength: 4096 },
  ],
  CameraEdit: [
    { name: "view", type: "View" },
  ],
  TechniqueEdit: [
    { name: "technique", type: "string", optional: true, maxLength: 64 },
    { name: "parameters", type: "f64{}", optional: true, maxItems: 64 },
  ],
  ResolveEdit: [
    { name: "exposure", type: "f32", optional: true, min: -64, max: 64 },
    { name: "toneMap", type: "ToneMap", optional: true },
    { name: "view", type: "ResolveView", optional: true },
  ],
  ImageEdit: [
    { name: "width", type: "u32", min: 16, max: 16384 },
    { name: "height", type: "u32", min: 16, max: 16384 },
  ],
  Limits: [
    { name: "maxControlBytes", type: "u32" },
    { name: "maxFragmentBytes", type: "u32" },
    { name: "framesInFlight", type: "u32" },
    { name: "maxEditsPerBatch", type: "u32" },
    { name: "maxImageSide", type: "u32" },
    { name: "maxClients", type: "u32" },
    { name: "messagesPerSecond", type: "u32" },
  ],
  TechniqueParameter: [
    { name: "name", type: "string" },
    { name: "description", type: "string" },
    { name: "unit", type: "string" },
    { name: "type", type: "ParameterType" },
    { name: "minimum", type: "f64" },
    { name: "maximum", type: "f64" },
    { name: "default", type: "f64" },
    { name: "cost", type: "CostClass" },
  ],
  Technique: [
    { name: "name", type: "string" },
    { name: "title", type: "string" },
    { name: "description", type: "string" },
    { name: "biased", type: "bool" },
    { name: "parameters", type: "TechniqueParameter[]" },
  ],
  EditableField: [
    { name: "name", type: "string" },
    { name: "kind", type: "FieldKind" },
    { name: "unit", type: "string" },
    { name: "description", type: "string" },
    { name: "minimum", type: "f64", optional: true },
    { name: "maximum", type: "f64", optional: true },
    { name: "softMinimum", type: "f64", optional: true },
    { name: "softMaximum", type: "f64", optional: true },
    { name: "choices", type: "string[]", optional: true },
  ],
  EditableTarget: [
    { name: "target", type: "string" },
    { name: "fields", type: "EditableField[]" },
  ],
  Material: [
    { name: "name", type: "string" },
    { name: "baseColor", type: "f32[4]" },
    { name: "metallic", type: "f32" },
    { name: "roughness", type: "f32" },
    { name: "emission", type: "f32[3]" },
    { name: "ior", type: "f32" },
    { name: "transmission", type: "f32" },
    { name: "thickness", type: "f32" },
    { name: "attenuationDistance", type: "f32" },
    { name: "attenuationColor", type: "f32[3]" },
    { name: "specular", type: "f32" },
    { name: "specularColor", type: "f32[3]" },
    { name: "clearcoat", type: "f32" },
    { name: "clearcoatRoughness", type: "f32" },
    { name: "normalScale", type: "f32" },
    { name: "alphaCutoff", type: "f32" },
    { name: "alphaMode", type: "AlphaMode" },
    { name: "doubleSided", type: "bool" },
    { name: "unlit", type: "bool" },
    { name: "textures", type: "string[]" },
  ],
  Light: [
    { name: "name", type: "string" },
    { name: "type", type: "LightType" },
    { name: "color", type: "f32[3]" },
    { name: "intensity", type: "f32" },
    { name: "range", type: "f32" },
    { name: "innerConeAngle", type: "f32" },
    { name: "outerConeAngle", type: "f32" },
  ],
  SceneNode: [
    { name: "name", type: "string" },
    { name: "parent", type: "u32", optional: true },
    { name: "translation", type: "f64[3]" },
    { name: "rotation", type: "f64[4]" },
    { name: "scale", type: "f64[3]" },
    { name: "matrix", type: "f64[16]", optional: true },
    { name: "mesh", type: "u32", optional: true },
    { name: "camera", type: "u32", optional: true },
    { name: "light", type: "u32", optional: true },
  ],
  Camera: [
    { name: "name", type: "string" },
    { name: "perspective", type: "bool" },
    { name: "yfov", type: "f32" },
    { name: "ymag", type: "f32" },
    { name: "znear", type: "f32" },
  ],
  Environment: [
    { name: "radiance", type: "f32[3]" },
    { name: "rotation", type: "f32" },
    { name: "hasImage", type: "bool" },
    { name: "image", type: "string" },
  ],
  Resolve: [
    { name: "exposure", type: "f32" },
    { name: "toneMap", type: "ToneMap" },
    { name: "view", type: "ResolveView" },
  ],
  Unsupported: [
    { name: "feature", type: "string" },
    { name: "materials", type: "string[]" },
    { name: "note", type: "string" },
  ],
  LoadReport: [
    { name: "unsupported", type: "Unsupported[]" },
    { name: "notes", type: "string[]" },
    { name: "triangles", type: "u53" },
    { name: "degenerateTriangles", type: "u53" },
    { name: "vertices", type: "u53" },
    { name: "imageBytes", type: "u53" },
  ],
  ClientHello: [
    { name: "seq", type: "u32", min: 1 },
    { name: "version", type: "u32" },
    { name: "client", type: "string", maxLength: 128 },
    { name: "encodings", type: "Encoding[]", optional: true, maxItems: 16 },
    { name: "watch", type: "bool", optional: true },
  ],
  Ping: [
    { name: "seq", type: "u32", min: 1 },
  ],
  Load: [
    { name: "seq", type: "u32", min: 1 },
    { name: "uri", type: "string", maxLength: 4096 },
  ],
  SetCamera: [
    { name: "seq", type: "u32", min: 1 },
    { name: "view", type: "View", inline: true },
  ],
  SetMessage: [
    { name: "seq", type: "u32", min: 1 },
    { name: "edit", type: "Edit", inline: true },
  ],
  Batch: [
    { name: "seq", type: "u32", min: 1 },
    { name: "edits", type: "Edit[]", minItems: 1, maxItems: 1024 },
  ],
  Pick: [
    { name: "seq", type: "u32", min: 1 },
    { name: "x", type: "u32", max: 16383 },
    { name: "y", type: "u32", max: 16383 },
  ],
  AckFrame: [
    { name: "seq", type: "u32", min: 1 },
    { name: "frameId", type: "u32" },
    { name: "receiveMs", type: "f32", optional: true, min: 0, max: 1000000000.0 },
    { name: "decodeMs", type: "f32", optional: true, min: 0, max: 1000000000.0 },
    { name: "dropped", type: "bool" },
  ],
  Save: [
    { name: "seq", type: "u32", min: 1 },
    { name: "layers", type: "string[]", optional: true, maxItems: 32, maxLength: 64 },
  ],
  Describe: [
    { name: "seq", type: "u32", min: 1 },
  ],
  Wait: [
    { name: "seq", type: "u32", min: 1 },
    { name: "steps", type: "u32", optional: true, min: 1 },
    { name: "error", type: "f32", optional: true, min: 1e-12, max: 1000000.0 },
  ],
  ClientBye: [
    { name: "seq", type: "u32", min: 1 },
  ],
  ServerHello: [
    { name: "seq", type: "u32" },
    { name: "version", type: "u32" },
    { name: "server", type: "string" },
    { name: "device", type: "string" },
    { name: "clientId", type: "u53" },
    { name: "limits", type: "Limits" },
    { name: "techniques", type: "Technique[]" },
    { name: "toneMaps", type: "ToneMap[]" },
    { name: "encodings", type: "Encoding[]" },
    { name: "layers", type: "string[]" },
    { name: "stages", type: "string[]", maxItems: 6 },
    { name: "editable", type: "EditableTarget[]" },
  ],
  Status: [
    { name: "phase", type: "Phase" },
    { name: "idle", type: "bool" },
    { name: "steps", type: "u32" },
    { name: "meanSamples", type: "f32" },
    { name: "estimatedError", type: "f32", optional: true },
    { name: "errorLow", type: "f32", optional: true },
    { name: "errorHigh", type: "f32", optional: true },
    { name: "raysPerSecond", type: "f64" },
    { name: "secondsSinceRestart", type: "f64" },
    { name: "discardedSamples", type: "u53" },
    { name: "discardedShare", type: "f64" },
    { name: "editsApplied", type: "u53" },
    { name: "restarts", type: "u53" },
    { name: "framesPublished", type: "u53" },
    { name: "quanta", type: "u53" },
    { name: "pipelinesCreated", type: "u32" },
    { name: "technique", type: "string" },
    { name: "ran", type: "string[]" },
    { name: "leftOut", type: "string[]" },
    { name: "memory", type: "u53{}" },
    { name: "stageMs", type: "f32{}" },
    { name: "figures", type: "f64{}" },
    { name: "clients", type: "u32" },
    { name: "framesSent", type: "u53" },
    { name: "framesReplaced", type: "u53" },
  ],
  Ack: [
    { name: "seq", type: "u32" },
    { name: "cost", type: "CostClass" },
    { name: "sceneRevision", type: "u32" },
    { name: "viewRevision", type: "u32" },
    { name: "superseded", type: "bool" },
  ],
  ErrorMessage: [
    { name: "seq", type: "u32", optional: true },
    { name: "code", type: "string" },
    { name: "message", type: "string" },
    { name: "place", type: "string", optional: true },
  ],
  Pong: [
    { name: "seq", type: "u32" },
    { name: "serverSeconds", type: "f64" },
  ],
  SceneMessage: [
    { name: "seq", type: "u32", optional: true },
    { name: "cause", type: "SceneCause" },
    { name: "name", type: "string" },
    { name: "hash", type: "hash" },
    { name: "sceneRevision", type: "u32" },
    { name: "viewRevision", type: "u32" },
    { name: "materials", type: "Material[]" },
    { name: "lights", type: "Light[]" },
    { name: "nodes", type: "SceneNode[]" },
    { name: "meshes", type: "string[]" },
    { name: "cameras", type: "Camera[]" },
    { name: "environment", type: "Environment" },
    { name: "view", type: "View" },
    { name: "resolve", type: "Resolve" },
    { name: "technique", type: "string" },
    { name: "parameters", type: "f64{}" },
    { name: "width", type: "u32" },
    { name: "height", type: "u32" },
    { name: "boundsLow", type: "f64[3]" },
    { name: "boundsHigh", type: "f64[3]" },
    { name: "report", type: "LoadReport" },
  ],
  Loaded: [
    { name: "seq", type: "u32" },
    { name: "seconds", type: "f64" },
    { name: "sceneRevision", type: "u32" },
    { name: "hash", type: "hash" },
  ],
  Picked: [
    { name: "seq", type: "u32" },
    { name: "hit", type: "bool" },
    { name: "node", type: "u32", optional: true },
    { name: "material", type: "u32", optional: true },
    { name: "primitive", type: "u32", optional: true },
    { name: "posW", type: "f64[3]", optional: true },
    { name: "normalW", type: "f32[3]", optional: true },
    { name: "distance", type: "f64", optional: true },
  ],
  Saved: [
    { name: "seq", type: "u32" },
    { name: "bytes", type: "u53" },
    { name: "encoding", type: "Encoding" },
  ],
  Waited: [
    { name: "seq", type: "u32" },
    { name: "steps", type: "u32" },
    { name: "filmHash", type: "hash" },
    { name: "estimatedError", type: "f32", optional: true },
    { name: "errorLow", type: "f32", optional: true },
    { name: "errorHigh", type: "f32", optional: true },
  ],
  ServerBye: [
    { name: "reason", type: "string" },
  ],
};

const kClientOps: { [op: string]: string } = { hello: "ClientHello", ping: "Ping", load: "Load", camera: "SetCamera", set: "SetMessage", batch: "Batch", pick: "Pick", ackFrame: "AckFrame", save: "Save", describe: "Describe", wait: "Wait", bye: "ClientBye" };

const kServerOps: { [op: string]: string } = { hello: "ServerHello", status: "Status", ack: "Ack", error: "ErrorMessage", pong: "Pong", scene: "SceneMessage", loaded: "Loaded", picked: "Picked", saved: "Saved", waited: "Waited", bye: "ServerBye" };

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
