// SPDX-License-Identifier: Apache-2.0
/**
 * The page: its parts, made one after the other. Each gets the others that it works with, which are made before it.
 *
 * Start reading here; each part is a file. The world moves on the server alone (world_state.js). `view/` draws it, `input/`
 * and `tools/` work it, `panels/` and `measures/` show and change what is selected, `ui/` stands around it. What makes a
 * ring goes by events: of the server (connection.js), of pointers (input/pointers.js), of what is selected
 * (input/selection.js).
 */

import {Connection} from './connection.js';
import {elementOf} from './dom.js';
import {FrameColumns} from './frame_columns.js';
import {Cursor} from './input/cursor.js';
import {Handles} from './input/handles.js';
import {Keyboard} from './input/keyboard.js';
import {Pointers} from './input/pointers.js';
import {Selection} from './input/selection.js';
import {Meters} from './measures/meters.js';
import {Plotting} from './measures/plotting.js';
import {Records} from './measures/records.js';
import {Stopwatch} from './measures/stopwatch.js';
import {Trail} from './measures/trail.js';
import {BodyPanel} from './panels/body_panel.js';
import {Driving} from './panels/driving.js';
import {jointContent} from './panels/joint_panel.js';
import {Panel} from './panels/panel.js';
import {severalContent} from './panels/several_panel.js';
import {WorldPanel} from './panels/world_panel.js';
import {People} from './people.js';
import {Eraser} from './tools/eraser.js';
import {Lasso} from './tools/freehand.js';
import {Answers} from './ui/answers.js';
import {Classroom} from './ui/classroom.js';
import {Dialog} from './ui/dialog.js';
import {Files} from './ui/files.js';
import {Hints} from './ui/hints.js';
import {Lessons} from './ui/lessons.js';
import {Narrator} from './ui/narrator.js';
import {Notes} from './ui/notes.js';
import {Readings} from './ui/readings.js';
import {ServerNotice} from './ui/server_notice.js';
import {Settings} from './ui/settings.js';
import {EmptyCard} from './ui/strokes.js';
import {TimeBar} from './ui/time_bar.js';
import {Tips} from './ui/tips.js';
import {makeToolbar, Toolbar, TopBar} from './ui/toolbar.js';
import {Arrows} from './view/arrows.js';
import {Camera} from './view/camera.js';
import {Room} from './view/room.js';
import {SceneView} from './view/scene_view.js';
import {Words} from './words.js';
import {WorldState} from './world_state.js';

const connection = new Connection();
const world = new WorldState(connection);
const camera = new Camera();
const view = new SceneView(elementOf('world', HTMLCanvasElement), world, camera);
const pointers = new Pointers(view);
const words = new Words(connection);
const dialog = new Dialog();
const people = new People({connection, pointers, world});
const frames = new FrameColumns({connection});
const notes = new Notes({camera, view});
new Answers({connection, notes, people, view, words, world});
const settings = new Settings({connection, dialog, frames, notes, world});
const selection = new Selection({camera, connection, frames, notes, pointers, view, words, world});
const cursor = new Cursor({camera, pointers, view});
const room = new Room({camera, connection, cursor, pointers, selection, view, world});
const records = new Records({connection, frames, world});
const arrows = new Arrows({camera, connection, frames, people, records, selection, view, world});
const trail = new Trail({arrows, camera, connection, records, view, world});
const meters = new Meters({connection, records, view, world});
const stopwatch = new Stopwatch({connection, notes, words});
const time = new TimeBar({connection, notes, people, pointers, view, words, world});
const files = new Files({connection, dialog, notes, people, room, words});
const lessons = new Lessons({connection, files, people, room, selection, time, words, world});
const plotting = new Plotting({connection, lessons, notes, records, room, selection, view, words, world});
const driving = new Driving({connection, people, selection, world});
const bodyPanel = new BodyPanel({connection, driving, meters, notes, plotting, records, selection, trail, view, words, world});
const worldPanel = new WorldPanel({connection, frames, people, world});
const panel = new Panel({connection, room, selection, view}, {
  body: (names, render) => bodyPanel.content(names, render),
  several: (names) => severalContent({connection, plotting, selection, world}, names),
  joint: (names) => jointContent({connection, meters, selection, words, world}, names),
  world: (_, render) => worldPanel.content(render),
  measure: () => stopwatch.content(),
});
new EmptyCard({connection, people, pointers, selection, view, world});
const handles = new Handles({arrows, camera, connection, people, pointers, selection, view, world});
const readings = new Readings({connection, notes, view, world});
const hints = new Hints({connection, notes, pointers, world});
const toolParts = {camera, connection, frames, hints, notes, people, readings, records, selection, view, world};
const toolbar = new Toolbar({...toolParts, pointers, room});
pointers.ends = {eraser: new Eraser(toolParts), button: new Lasso(toolParts)};
/** @type {?import('./input/menu.js').Menu} null until it is asked for */
let menu = null;
pointers.on('menu', (page) => notes.load(import('./input/menu.js'), ({Menu}) => {
  menu ??= new Menu({camera, people, plotting, pointers, room, selection, view, world});
  menu.open(page);
}));
new Keyboard({camera, cursor, dialog, driving, panel, people, plotting, pointers, readings, room, selection, settings, stopwatch,
  time, toolbar, view, world});
new TopBar({arrows, camera, connection, dialog, files, lessons, notes, room, selection, settings, view, world});
new Classroom({camera, connection, dialog, lessons, notes, people, selection, view});
new Narrator({connection, selection, settings, words, world});
new Tips();
for (const id of ['tools', 'files', 'looks', 'edit', 'marks', 'legend']) makeToolbar(elementOf(id));
makeToolbar(elementOf('time'), '[data-icon=play]');
// What somebody does may change the picture: a pointer only on the canvas. The view itself follows what the server tells.
for (const type of ['pointerdown', 'pointermove', 'pointerup', 'pointercancel', 'pointerout', 'wheel']) view.canvas.addEventListener(type, () => view.redraw());
for (const type of ['keydown', 'keyup', 'click', 'input', 'change']) document.addEventListener(type, () => view.redraw(), true);
new ServerNotice({connection, dialog, notes, people, pointers});
// A link with which the page is opened; in an open page, one loads it again.
addEventListener('hashchange', () => location.reload());
if (/[?#&](world|lesson|t)=/.test(location.href)) {
  await notes.load(import('./ui/links.js'), ({Links}) => new Links({connection, dialog, files, lessons, notes, people, world}));
}
connection.connect();

/** Parts that tests of the page look into. */
export {arrows, handles, records, world};
/** What a program sees that drives this page. */
Object.assign(window, {physsim: {
  toPage: (/** @type {number} */ x, /** @type {number} */ y) => camera.toPage(x, y),
  toWorld: (/** @type {number} */ px, /** @type {number} */ py) => camera.toWorld(px, py),
  get time() { return world.frame.time; },
  get speed() { return world.frame.speed; },
  get bodies() {
    const {frame, scene, count} = world;
    return Object.fromEntries(scene.bodies.slice(0, count).map(({name}, row) =>
      [name, [frame.x[row], frame.y[row], frame.yaw[row]]]));
  },
}});
