// SPDX-License-Identifier: Apache-2.0
/** What the panel shows of each kind of subject; loaded with the first panel. */

import {bodyContent} from './body_panel.js';
import {jointContent} from './joint_panel.js';
import {severalContent} from './several_panel.js';
import {worldContent} from './world_panel.js';

/** @import {Kind} from '../input/selection.js' */
/** @import {PanelParts} from '../types.js' */
/** @import {Content} from './panel.js' */

/** By the names of the subject; null where that is gone. @type {Record<Exclude<Kind, ''>, (parts: PanelParts, names: string[], render: () => void) => ?Content>} */
export const CONTENTS = {body: bodyContent, several: severalContent, joint: jointContent, world: worldContent, measure: ({stopwatch}) => stopwatch.content()};
