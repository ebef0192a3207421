// SPDX-License-Identifier: Apache-2.0
/** The large plot and tables, whose scripts are loaded when somebody asks for them. */

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
    this.parts.notes.load(import('./plot_window.js'), ({PlotWindow: Plot}) => {
      this.window ??= new Plot(this.parts);
      this.window.open(names);
    });
  }

  /** @param {string[]} names of bodies */
  saveTable(names) {
    this.parts.notes.load(import('./table.js'), ({saveTable}) => saveTable(this.parts, names));
  }

  /** @returns {boolean} whether the plot was open, which is closed */
  close() {
    const wasOpen = this.window?.isOpen ?? false;
    if (wasOpen) this.window?.close();
    return wasOpen;
  }
}
