// SPDX-License-Identifier: Apache-2.0
/**
 * Types that files of the page share: messages of the server (docs/page_protocol.md), and tools.
 *
 * The browser never loads this file; `make lint` and editors read it.
 */

export type {Camera} from './view/camera.js';
export type {Connection} from './connection.js';
export type {Palette} from './view/theme.js';
export type {SceneView} from './view/scene_view.js';
export type {Tool} from './tools/tool.js';
export type {WorldState} from './world_state.js';

/** What parts of the page work with, by the names that app.js gives to them. */
interface Page {
  arrows: import('./view/arrows.js').Arrows;
  camera: import('./view/camera.js').Camera;
  connection: import('./connection.js').Connection;
  cursor: import('./input/cursor.js').Cursor;
  dialog: import('./ui/dialog.js').Dialog;
  driving: import('./panels/driving.js').Driving;
  files: import('./ui/files.js').Files;
  frames: import('./frame_columns.js').FrameColumns;
  hints: import('./ui/hints.js').Hints;
  lessons: import('./ui/lessons.js').Lessons;
  meters: import('./measures/meters.js').Meters;
  notes: import('./ui/notes.js').Notes;
  panel: import('./panels/panel.js').Panel;
  people: import('./people.js').People;
  plotting: import('./measures/plotting.js').Plotting;
  pointers: import('./input/pointers.js').Pointers;
  readings: import('./ui/readings.js').Readings;
  records: import('./measures/records.js').Records;
  room: import('./view/room.js').Room;
  selection: import('./input/selection.js').Selection;
  settings: import('./ui/settings.js').Settings;
  stopwatch: import('./measures/stopwatch.js').Stopwatch;
  time: import('./ui/time_bar.js').TimeBar;
  toolbar: import('./ui/toolbar.js').Toolbar;
  trail: import('./measures/trail.js').Trail;
  view: import('./view/scene_view.js').SceneView;
  words: import('./words.js').Words;
  world: import('./world_state.js').WorldState;
}

/** What a part of the page works with: others, by their names. They are made before it. */
export type Parts<Names extends keyof Page> = Pick<Page, Names>;

/** What tools work with, all in all; each says what it uses itself. */
export type ToolParts = Parts<'camera' | 'connection' | 'frames' | 'hints' | 'notes' | 'people' | 'readings' | 'records' | 'selection' | 'view' | 'world'>;

/** x, y [m]; on the page [px]. */
export type Point = [number, number];

/** xmin, ymin, xmax, ymax [m]. */
export type Bounds = [number, number, number, number];

/** Of a body, in its frame [m]; the fields are those of its kind. */
export interface Shape {
  kind: string;
  radius: number;
  center?: Point;
  outline: Point[];
  points: Point[];
  thickness: number;
  pieces: Shape[];
  /** Of a rectangle. */
  width?: number;
  height?: number;
}

export interface Body {
  name: string;
  shape: Shape;
  color: number[];
  anchored: boolean;
  kinematic: boolean;
  sensor: boolean;
  /** Velocity of its surface, counter-clockwise [m/s]. */
  belt?: number;
  /** Of a conveyor seen from above, in its axes [m/s]. */
  surface_velocity?: Point;
  rolling_resistance?: number;
  /** Direction in its axes in which others pass it. */
  one_way?: Point;
  closed_sides?: boolean;
  label: string;
  mass: number;
  moment: number;
  density: number;
  friction: number;
  elasticity: number;
  centroid: Point;
  robot?: Robot;
  forces?: AppliedForce[];
  actor?: Actor;
  medium?: Medium;
  /** [C] */
  charge?: number;
}

/** What fills the region of a body, as world files have it. */
export interface Medium {
  /** [kg/m²] */
  density: number;
  /** [N s/m²] */
  viscosity: number;
  drag: number;
  /** In the frame of the body [m/s]. */
  flow: Point;
  /** [m/s] */
  gusts: number;
}

/** What moves a body on its own, as world files have it. */
export interface Actor {
  kind: 'path' | 'social_force' | 'orca';
  /** x, y [m], and of a path yaw [rad]. */
  points: number[][];
  /** [m/s] */
  speed?: number;
  repeat?: 'once' | 'loop' | 'to_and_fro';
  start?: {gate?: string, near?: string, distance?: number, time?: number};
}

/** A constant force on a body. */
export interface AppliedForce {
  /** [N] */
  force: Point;
  /** Where it acts, in the frame of the body [m]; its centre of mass, if it is not given. */
  at?: Point;
  axes?: 'world' | 'body';
}

export interface Robot {
  namespace: string;
  /** Of its drive, if it has one. */
  kind?: string;
  /** [m/s] */
  max_speed?: number;
  /** [rad/s] */
  max_turn?: number;
  /** Names of its links. */
  parts?: string[];
}

export interface Joint {
  name: string;
  kind: string;
  /** Rows of its bodies; -1 is the background. */
  a: number;
  b: number;
  points: Point[];
  axis: Point;
  rest_length: number;
  /** What a rope passes between its points: row of a body, place in it [m], radius of a wheel. */
  guides?: [number, number, number, number][];
  lower?: number;
  upper?: number;
  rate?: number;
  max_torque?: number;
  stiffness?: number;
  damping?: number;
  /** Of a torsion spring [rad]. */
  rest_angle?: number;
  /** Of a bearing or a slide [N m, N]. */
  friction?: number;
  length?: number;
  ratio?: number;
  /** Name of the body about which the angles of a gear are measured. */
  carrier?: string;
  /** 1 of an axle that turns counter-clockwise only, -1 of one that turns clockwise. */
  ratchet?: number;
  /** Greatest torque or force of its motor, if that is commanded [N m, N]. */
  effort?: number;
  max_force?: number;
  break_force?: number;
}

export interface Scene {
  epoch: number;
  bodies: Body[];
  joints: Joint[];
  gravity: Point;
  bounds: Bounds | [];
  damping: number;
  density: number;
  friction: number;
  elasticity: number;
  /** Of the air [kg/m²], [N s/m²], [m/s]. */
  air_density: number;
  air_viscosity: number;
  wind: Point;
  gusts: number;
  /** Of attraction, by masses and by charges. */
  gravitation: number;
  coulomb: number;
  lesson?: Lesson | null;
}

/** A task that belongs to the world. */
export interface Lesson {
  number: number;
  title: string;
  question: string;
  hint: string;
  measure: string;
  unit: string;
  figure: number;
  within: number;
  answer: string;
  /** What is shown first: x and y, least and greatest [m]. */
  view?: Bounds | null;
}

/** The state of the world after a step, a column for each quantity; rows as in the scene. */
export interface Frame {
  epoch: number;
  time: number;
  speed: number;
  ghost: boolean;
  x: Float32Array;
  y: Float32Array;
  yaw: Float32Array;
  velocities?: {x: Float32Array, y: Float32Array, spin: Float32Array};
  /** Rows a and b of the pairs, -1 is a wall; impulses on b [N s], summed over steps. */
  contacts?: {steps: number, a: Int32Array, b: Int32Array, x: Float32Array, y: Float32Array,
    nx: Float32Array, ny: Float32Array, jx: Float32Array, jy: Float32Array};
  forces?: Float32Array;
  hands?: {x: Float32Array, y: Float32Array, toX: Float32Array, toY: Float32Array};
  /** Of each joint on its body b [N]. */
  pulls?: {x: Float32Array, y: Float32Array};
  /** Of media and attraction on each body [N]. */
  fields?: {x: Float32Array, y: Float32Array};
  /** Of the selected robot: its laser, then the ends of its beams; hit: 1 where they hit something. */
  scan?: {x: Float32Array, y: Float32Array, hit: Float32Array};
}

/** The motion of a body's centre of mass at a time [s, m, rad, m/s, rad/s]. */
export interface Sample {
  time: number;
  x: number;
  y: number;
  yaw: number;
  vx: number;
  vy: number;
  spin: number;
  /** Mean acceleration since the sample before [m/s²]. */
  ax?: number;
  ay?: number;
  /** Mean angular acceleration since then [rad/s²]. */
  spinning?: number;
  /** Forces on it by their kind [N], where they were shown or plotted. */
  forces?: Record<string, number>;
}

/** On the body of a row. */
export interface Force {
  kind: 'weight' | 'normal' | 'friction' | 'joint' | 'applied' | 'air' | 'sum';
  row: number;
  /** [m] */
  at: Point;
  /** [N] */
  x: number;
  y: number;
  /** Whether its reaction acts on a body that moves, too. */
  mutual: boolean;
}

/** A course that was left, from .. to [s]. */
export interface Course {
  id: number;
  from: number;
  to: number;
}

export interface Timeline {
  state: string;
  oldest: number;
  now: number;
  newest: number;
  course: number;
  /** Number of the line of events in force. */
  line: number;
  /** Time from which on it may differ from the line before [s]. */
  parts: number;
  undo_text: Text;
  redo_text: Text;
  speed: number;
  courses?: Course[];
}

/** A text of the server: the template that the page translates, and its values by name. */
export type Text = [template: string, values: Record<string, string | Text>];

export interface Answer {
  request: string;
  ok: boolean;
  code: string;
  text: Text;
  subject: string;
  topic: string;
  values: Record<string, string>;
  /** Number of the page that asked, where that is another one. */
  page?: number;
}

/** Somebody at a page of this world. */
export interface Classmate {
  page: number;
  name: string;
  /** Number of the colour. */
  color: number;
  role: string;
  /** The last answer to a lesson. */
  answered: Result | null;
  /** Whether a hand is raised. */
  raised: boolean;
}

/** An answer to a lesson. */
export interface Result {
  person: string;
  /** Title of the lesson. */
  lesson: string;
  answer: string;
  right: boolean;
  /** [s since 1970] */
  at: number;
  /** Up to the first right one. */
  tries: number;
  /** Number of the world in the class. */
  world?: number;
}

/** What a stroke is read as. */
export interface Reading {
  request: string;
  meaning: string;
  confidence: number;
  runner_up: string;
  runner_up_confidence: number;
  guesses: [string, number][];
  /** Meanings that earlier strokes now have, over its new body. */
  also: string[];
  outline: Point[];
  built: boolean;
}

/** A pointer on the canvas. */
export interface Touch {
  /** [m] */
  at: Point;
  /** [px] */
  page: Point;
  /** [s] */
  time: number;
  /** How far beside a body counts [m]. */
  slop: number;
  /** Whether the key is held with which a copy is dragged. */
  copies: boolean;
  /** Distance of the lines that it snaps to [m]; 0 where the key is not held. */
  grid: number;
}

/** How a tool of clicks is used. */
export interface ClickUse {
  clicks: number;
  /** Colour of the body that its first click is for. */
  aims?: 'accent' | 'warn';
  /** Whether its clicks are for bodies, or the background. */
  joins?: boolean;
  /** Whether its second point lies at a multiple of an angle from the first, while the key of the grid is held. */
  angled?: boolean;
  arrow?: boolean;
}
