// SPDX-License-Identifier: Apache-2.0
/**
 * The page: one object that knows its parts and the tool in use.
 *
 * Start reading here; each part is a file. The world moves on the server alone (world_state.js). `view/` draws it, `input/`
 * and `tools/` work it, `panels/` and `measures/` show and change what is selected, `ui/` stands around it.
 */

import {Arrows} from './view/arrows.js';
import {Camera} from './view/camera.js';
import {Classroom} from './ui/classroom.js';
import {Connection} from './connection.js';
import {Dialog} from './ui/dialog.js';
import {elementOf} from './dom.js';
import {Driving} from './panels/driving.js';
import {Gallery} from './ui/gallery.js';
import {Handles} from './input/handles.js';
import {Hints, Tips} from './ui/hints.js';
import {Cursor} from './input/cursor.js';
import {Eraser} from './tools/eraser.js';
import {Gestures} from './input/gestures.js';
import {Keyboard} from './input/keyboard.js';
import {Lasso} from './tools/freehand.js';
import {Lessons} from './ui/lessons.js';
import {Links} from './ui/links.js';
import {Narrator, Sound} from './ui/narrator.js';
import {Notes, Refusals} from './ui/notes.js';
import {Menu} from './input/menu.js';
import {Meters} from './measures/meters.js';
import {Numbers} from './measures/numbers.js';
import {Panel} from './panels/panel.js';
import {Plots} from './measures/plots.js';
import {Records, Trail} from './measures/records.js';
import {Room} from './view/room.js';
import {SceneView} from './view/scene_view.js';
import {Selection} from './input/selection.js';
import {Settings} from './ui/settings.js';
import {Stopwatch} from './measures/stopwatch.js';
import {t} from './strings.js';
import {EmptyCard, Readings} from './ui/strokes.js';
import {TimeBar} from './ui/time_bar.js';
import {makeToolbar, Toolbar, TopBar} from './ui/toolbar.js';
import {Words} from './words.js';
import {WorldState} from './world_state.js';

/** @import {PlotWindow} from './measures/plot_window.js' */

export class App {
  constructor() {
    this.viewOnly = new URLSearchParams(location.search).has('view');
    document.body.classList.toggle('view', this.viewOnly);
    /** @type {Record<string, any>} properties of the next drawings that this page has chosen; others are the world's */
    this.material = {};
    /** @type {number | undefined} of the server's protocol */
    this.version = undefined;
    /** @type {?string | number[]} of the next drawings, where this page chose none */
    this.color = null;

    this.connection = new Connection();
    this.world = new WorldState(this.connection);
    this.camera = new Camera();
    this.view = new SceneView(elementOf('world', HTMLCanvasElement), this.world, this.camera);
    this.gestures = new Gestures(this.view);
    this.gestures.onlyMoves = this.viewOnly;
    this.selection = new Selection(this);
    this.cursor = new Cursor(this);
    this.arrows = new Arrows(this);
    this.words = new Words(this.connection);
    this.notes = new Notes(this);
    this.refusals = new Refusals(this);
    this.readings = new Readings(this);
    this.driving = new Driving(this);
    this.sound = new Sound(this);
    this.records = new Records(this);
    this.trail = new Trail(this);
    this.meters = new Meters(this);
    /** @type {?PlotWindow} null until a plot is asked for */
    this.plotWindow = null;
    this.numbers = new Numbers(this);
    this.plots = new Plots(this);
    this.panel = new Panel(this);
    this.stopwatch = new Stopwatch(this);
    this.handles = new Handles(this);
    this.time = new TimeBar(this);
    this.lessons = new Lessons(this);
    this.dialog = new Dialog();
    this.gallery = new Gallery(this);
    this.links = new Links(this);
    this.hints = new Hints(this);
    this.toolbar = new Toolbar(this);
    this.gestures.ends = {eraser: new Eraser(this), button: new Lasso(this)};
    this.menu = new Menu(this);
    this.keyboard = new Keyboard(this);
    this.topBar = new TopBar(this);
    this.classroom = new Classroom(this);
    this.tips = new Tips();
    this.card = new EmptyCard(this);
    this.room = new Room(this);
    this.settings = new Settings(this);
    this.narrator = new Narrator(this);
    for (const id of ['tools', 'files', 'looks', 'edit', 'marks', 'legend']) makeToolbar(elementOf(id));
    makeToolbar(elementOf('time'), '[data-icon=play]');
    this.#listen();
    this.connection.connect();
  }

  #listen() {
    // What somebody does may change the picture. The view itself follows what the server tells.
    for (const type of ['pointerdown', 'pointermove', 'pointerup', 'pointerout', 'wheel', 'keydown', 'keyup', 'click', 'input', 'change']) {
      document.addEventListener(type, () => { this.view.dirty = true; }, true);
    }
    const {connection} = this, gone = elementOf('gone');
    connection.on('welcome', ({version, settings = {}, view_only: viewOnly}) => {
      // These scripts come from another version of the server.
      if (version !== (this.version ??= version)) location.reload();
      this.viewOnly ||= Boolean(viewOnly);
      document.body.classList.toggle('view', this.viewOnly);
      this.gestures.onlyMoves = this.viewOnly;
      this.color = settings.draw_color ?? null;
      // The server knows this page as a new one, without a material.
      if (Object.keys(this.material).length && !this.viewOnly) this.connection.send('draw_with', this.material);
      this.askForParts();
    });
    let away = false; // without a socket
    const isBack = () => {
      away = false;
      if (!gone.hidden) this.notes.showMessage(t('Connected again'));
      gone.hidden = true;
    };
    connection.on('open', isBack);
    connection.on('heard', isBack);
    connection.on('silent', () => {
      gone.hidden = false;
      gone.textContent = t('The server does not answer. What you draw is sent when it does.');
    });
    connection.on('again', ({sent, lost}) => {
      if (lost) this.notes.showMessage(t('Connected again. Of what you did meanwhile, {count} may be lost.', {count: lost}), {ok: false});
      else if (sent) this.notes.showMessage(t('Connected again. What you did meanwhile is sent now.'));
    });
    connection.on('closed', ({status, opened}) => {
      // The server forgets the gestures that it knows of; a stroke is drawn to its end.
      if (!away && this.gestures.tool.atServer) this.gestures.cancelAll();
      away = true;
      gone.hidden = false;
      gone.textContent = status === 401 || status === 403 ?
        t('Wrong token: open the address that the node printed.') :
        !status ? t('The server is gone. This page comes back with it.') :
          opened ? t('Connecting again …') : t('The server refused this page; trying again …');
    });
  }

  /**
   * Work with a script that is loaded when somebody asks for it.
   * @template T
   * @param {Promise<T>} loading
   * @param {(script: T) => void} work
   */
  async with(loading, work) {
    const script = await loading.catch(() => null);
    if (script) work(script);
    else this.notes.showMessage(t('Not done: the server is not reachable'), {ok: false});
  }

  showHelp() {
    this.with(import('./ui/help.js'), ({showHelp}) => showHelp(this));
  }

  /**
   * Show the large plot, or a table of it.
   * @param {(plot: PlotWindow) => void} work
   */
  plot(work) {
    this.with(import('./measures/plot_window.js'), ({PlotWindow: Plot}) => work(this.plotWindow ??= new Plot(this)));
  }

  /** Ask for the parts of frames that are shown. */
  askForParts() {
    const {arrows, records, panel: {name}} = this, told = this.settings?.speaks || this.selection.names.size > 0;
    this.connection.send('show', {
      // The drag of the air follows from velocities.
      velocities: arrows.velocities || arrows.forces || told || records.records || this.gestures.tool.measures === true,
      contacts: arrows.forces || told || this.sound.on || records.records,
      forces: true,
      laser: this.world.body(name)?.robot ? name : '',
    });
  }
}

const app = new App();

Object.assign(window, {physsim: {
  toPage: (/** @type {number} */ x, /** @type {number} */ y) => app.camera.toPage(x, y),
  toWorld: (/** @type {number} */ px, /** @type {number} */ py) => app.camera.toWorld(px, py),
  get time() { return app.world.frame.time; },
  get speed() { return app.world.frame.speed; },
  /** Forces as they are drawn. */
  get forces() { return app.arrows.drawn; },
  /** Of the air [m/s]. */
  get wind() { return app.world.scene.wind; },
  /** Impacts that were heard. */
  get heard() { return app.sound.heard; },
  /** Lengths of arrows [px] to a newton and to a metre a second. */
  get scales() { return {newton: app.arrows.scales.N.length(1), speed: app.arrows.scales['m/s'].length(1)}; },
  /** Numbers of samples of the bodies that are recorded, and of the course that was left. */
  get records() {
    return Object.fromEntries([...app.records.bodies].map(([name, {samples, left}]) => [name, [samples.length, left.length]]));
  },
  /** Places of the handles of the selected body [px]. */
  get handles() { return app.handles.places(); },
  get bodies() {
    const {frame, scene, count} = app.world;
    return Object.fromEntries(scene.bodies.slice(0, count).map(({name}, row) =>
      [name, [frame.x[row], frame.y[row], frame.yaw[row]]]));
  },
}});
