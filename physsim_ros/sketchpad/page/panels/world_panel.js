// SPDX-License-Identifier: Apache-2.0
/** What the panel shows of the world: the material of the next drawings, gravity, air, sound. */

import {checkField} from '../dom.js';
import {airFields} from './field_fields.js';
import {Gravity} from './gravity.js';
import {hexOf, Material, materialFields} from './material.js';
import {t} from '../strings.js';
import {Sound} from '../ui/sound.js';

/** @import {Parts} from '../types.js' */
/** @import {Content} from './panel.js' */

export class WorldPanel {
  /** @param {Parts<'connection' | 'frames' | 'people' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.gravity = new Gravity(parts);
    this.material = new Material(parts);
    this.sound = new Sound(parts);
  }

  /**
   * @param {() => void} render the panel again
   * @returns {Content}
   */
  content(render) {
    const {parts, material, sound} = this, {color: chosen} = material, color = chosen || [0.3, 0.47, 0.66];
    const any = checkField(t('Each body another colour'), !chosen, (checked) => material.change({color: checked ? '' : hexOf(color)}));
    return {title: t('Material of new bodies'), rest: [
      ...materialFields({...parts.world.scene, ...material.chosen, color}, (properties) => {
        if (properties.color) /** @type {HTMLInputElement} */ (any.control).checked = false;
        material.change(properties);
        // A material that was pressed is shown in the fields below.
        if (properties.density && properties.friction) render();
      }),
      any,
      ...this.gravity.fields(),
      ...airFields(parts),
      checkField(t('Sound of impacts'), sound.on, () => sound.toggle())]};
  }
}
