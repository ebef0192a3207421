// SPDX-License-Identifier: Apache-2.0
/** The large plot, whose script is loaded when somebody asks for it, and tables. */

/** @import {PlotParts, PlotWindow} from './plot_window.js' */

export class Plotting {
  /** @param {PlotParts} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {?PlotWindow} null until it is asked for */
    this.window = null;
  }

  /** @param {string[]} names of bodies */
  open(names) {
    this.#with((plot) => plot.open(names));
  }

  /** @param {string[]} names of bodies */
  saveTable(names) {
    this.#with((plot) => plot.saveTable(names));
  }

  /** @returns {boolean} whether the plot was open, which is closed */
  close() {
    const wasOpen = this.window?.isOpen ?? false;
    if (wasOpen) this.window?.close();
    return wasOpen;
  }

  /** @param {(plot: PlotWindow) => void} work */
  #with(work) {
    this.parts.notes.load(import('./plot_window.js'), ({PlotWindow: Plot}) => work(this.window ??= new Plot(this.parts)));
  }
}
